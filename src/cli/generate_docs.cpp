/// rejoin generate-docs: man pages and bash completion from the options as they are defined.
#include <fmt/core.h>

#include "cli/command.hpp"
#include "cli/help.hpp"
#include "core/files.hpp"
#include "core/version.hpp"

namespace rejoin::cli {
namespace {

/// Text for roff: backslashes and hyphens are its own, and so is a dot that starts a line.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\' || c == '-') result += '\\';
    result += c;
  }
  return result.starts_with('.') ? "\\&" + result : result;
}

std::string man_page(const CLI::App& app, const std::string& title) {
  std::string page = fmt::format(".TH {} 1 \"\" \"rejoin {}\"\n.SH NAME\n{} \\- {}\n", title, kVersion,
                                 escaped(title), escaped(app.get_description()));
  page += fmt::format(".SH SYNOPSIS\n{}\n", escaped(usage_line(app)));
  const auto commands = visible_subcommands(app);
  if (!commands.empty()) page += ".SH COMMANDS\n";
  for (const CLI::App* command : commands) {
    page += fmt::format(".TP\n\\fB{}\\fR\n{}  See \\fB{}\\fR(1).\n", command->get_name(),
                        escaped(command->get_description()), escaped(title + "-" + command->get_name()));
  }
  for (const HelpGroup& group : help_groups(app)) {
    page += fmt::format(".SH {}\n", group.heading);
    for (const HelpLine& line : group.lines) {
      page += fmt::format(".TP\n\\fB{}\\fR \\fI{}\\fR\n{}\n", escaped(line.names), escaped(line.argument),
                          escaped(line.description));
    }
  }
  return page +
         ".SH EXIT STATUS\n0 done (also when the answer is \"no join\"), 1 failure, 2 wrong use, 130 "
         "interrupted by Ctrl-C (143 by SIGTERM, 129 by SIGHUP).\n";
}

/// The visible long options of a command, separated by blanks.
std::string long_options(const CLI::App& app) {
  std::string words;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    for (const std::string& name : option->get_lnames()) words += "--" + name + " ";
  }
  return words;
}

/// Sets the words that may follow a command; of one with commands of its own, those of the command named next.
std::string words_of(const CLI::App& command, const std::string& everywhere) {
  const std::vector<const CLI::App*> own = visible_subcommands(command);
  std::string text = own.empty() ? "" : "place=2; ";
  text += fmt::format("words=\"{}{}", long_options(command), everywhere);
  for (const CLI::App* sub : own) text += sub->get_name() + " ";
  text += "\"";
  if (own.empty()) return text;
  text += "; case ${COMP_WORDS[2]} in ";
  for (const CLI::App* sub : own)
    text += fmt::format("{}) words=\"{}{}\" ;; ", sub->get_name(), long_options(*sub), everywhere);
  return text + "esac";
}

void write_man_pages(const CLI::App& app, const std::string& title, const std::filesystem::path& folder) {
  write_file(folder / (title + ".1"), man_page(app, title));
  for (const CLI::App* command : visible_subcommands(app))
    write_man_pages(*command, title + "-" + command->get_name(), folder);
}

std::string completion(const CLI::App& root) {
  std::string commands;
  std::string cases;
  for (const CLI::App* command : visible_subcommands(root)) {
    commands += command->get_name() + " ";
    cases += fmt::format("    {}) {} ;;\n", command->get_name(), words_of(*command, long_options(root)));
  }
  return "_rejoin() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} words place=1\n"
         "  case ${COMP_WORDS[1]} in\n" +
         cases + fmt::format("    *) words=\"{}{}\" ;;\n", commands, long_options(root)) +
         "  esac\n"
         "  [[ $current == -* || $COMP_CWORD -le $place ]] && COMPREPLY=($(compgen -W \"$words\" -- "
         "\"$current\"))\n"
         "}\n"
         "complete -o default -F _rejoin rejoin\n";
}

class GenerateDocsCommand final : public Command {
 public:
  explicit GenerateDocsCommand(const CLI::App& root) : root_(root) {}

  void define(CLI::App& app) override { app.add_option("DIR", folder_, "where to write")->required(); }

  ExitCode run(Console& /*console*/, Context& /*context*/) override {
    const std::filesystem::path folder(folder_);
    require_writable_folder(folder);
    write_man_pages(root_, "rejoin", folder);
    write_file(folder / "rejoin.bash", completion(root_));
    return kDone;
  }

 private:
  const CLI::App& root_;
  std::string folder_;
};

}  // namespace

std::unique_ptr<Command> make_generate_docs_command(const CLI::App& root) {
  return std::make_unique<GenerateDocsCommand>(root);
}

}  // namespace rejoin::cli
