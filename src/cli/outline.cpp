/// rejoin outline: the commands for flat pieces.
#include <vector>

#include "cli/outline_command.hpp"

namespace rejoin::cli {
namespace {

/// One of the commands with its part of the command line.
struct Entry {
  CLI::App* app;
  std::unique_ptr<Command> command;
};

class OutlineCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.require_subcommand(0, 1);
    add(app, "calibrate", "Set the multi-scale method by known joins.", make_outline_calibrate_command());
    add(app, "match", "Find how flat piece B joins A.", make_outline_match_command());
    add(app, "assemble", "Put the pieces of a folder together.", make_outline_assemble_command());
    add(app, "shatter", "Break made objects into pieces with known joins.", make_outline_shatter_command());
  }

  ExitCode run(Console& console, Context& context) override {
    for (const Entry& entry : entries_) {
      if (entry.app->parsed()) return entry.command->run(console, context);
    }
    throw UsageError("rejoin outline", "no command is given", "see rejoin outline --help");
  }

 private:
  void add(CLI::App& app, const char* name, const char* description, std::unique_ptr<Command> command) {
    CLI::App* sub = app.add_subcommand(name, description);
    command->define(*sub);
    sub->fallthrough();
    sub->set_help_flag("-h,--help")->group("");
    sub->footer("Everywhere: --threads N, --quiet, --verbose, --help  (rejoin --help)");
    entries_.push_back({sub, std::move(command)});
  }

  std::vector<Entry> entries_;
};

}  // namespace

std::unique_ptr<Command> make_outline_command() {
  return std::make_unique<OutlineCommand>();
}

}  // namespace rejoin::cli
