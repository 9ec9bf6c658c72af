/// Entry point: finds the subcommand, runs it, and turns whatever happens into an exit code.
#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/broken_pipe.hpp"
#include "cli/command.hpp"
#include "cli/help.hpp"
#include "cli/interrupt.hpp"
#include "cli/outputs.hpp"
#include "core/files.hpp"
#include "core/parallel.hpp"
#include "core/version.hpp"

namespace rejoin::cli {
namespace {

struct Entry {
  CLI::App* app;
  std::unique_ptr<Command> command;
};

/// Options that every subcommand knows.
struct Common {
  int threads = 0;
  bool quiet = false;
  bool verbose = false;
};

Entry add_command(CLI::App& root, const char* name, const char* description,
                  std::unique_ptr<Command> command) {
  CLI::App* app = root.add_subcommand(name, description);
  command->define(*app);
  app->fallthrough();  // the common options may follow the subcommand
  app->set_help_flag("-h,--help")->group("");
  app->footer("Everywhere: --threads N, --quiet, --verbose, --help  (rejoin --help)");
  return {app, std::move(command)};
}

std::vector<Entry> add_commands(CLI::App& root) {
  std::vector<Entry> entries;
  entries.push_back(add_command(root, "match", "Find the pose at which B joins A.", make_match_command()));
  entries.push_back(add_command(root, "compare", "Tell a pose's score; check its error by ray casting.",
                                make_compare_command()));
  entries.push_back(
      add_command(root, "facets", "Show the surfaces along which A may join.", make_facets_command()));
  entries.push_back(
      add_command(root, "outline", "Flat pieces: pictures and outlines.", make_outline_command()));
  entries.push_back(add_command(root, "assemble", "Put all fragments of a run or folder together.",
                                make_assemble_command()));
  entries.push_back(add_command(root, "shatter", "Break a closed mesh into fragments with known poses.",
                                make_shatter_command()));
  entries.push_back(add_command(root, "split", "Give every piece of a scan a file, without the table.",
                                make_split_command()));
  entries.push_back(
      add_command(root, "batch", "Match every pair of scans in a folder.", make_batch_command()));
  entries.push_back(add_command(root, "report", "Write a run as one HTML page.", make_report_command()));
  entries.push_back(
      add_command(root, "merge", "Put the runs of several shards together.", make_merge_command()));
  entries.push_back(add_command(root, "info", "Version, backends, threads.", make_info_command()));
  entries.push_back(add_command(root, "bench", "Measure the speed of every backend.", make_bench_command()));
  entries.push_back(add_command(root, "generate-docs", "Write man pages and completion.",
                                make_generate_docs_command(root)));
  entries.back().app->group("");
  return entries;
}

void add_common(CLI::App& root, Common& common) {
  root.formatter(std::make_shared<HelpFormatter>());
  root.require_subcommand(0, 1);
  root.set_help_flag("-h,--help", "show this, or a command's own help")->group("Everywhere");
  root.set_version_flag("--version", std::string("rejoin ") + kVersion, "show the version")
      ->group("Everywhere");
  root.add_option("--threads", common.threads, "threads to use, 0 to 1024 (0: all cores)")
      ->type_name("N")
      ->check(whole_in_range(0, 1024))
      ->group("Everywhere");
  root.add_flag("--quiet", common.quiet, "only warnings and errors, no results")->group("Everywhere");
  root.add_flag("--verbose", common.verbose, "tell on stderr what takes how long")->group("Everywhere");
}

int run(const std::vector<Entry>& entries, const Common& common) {
  Console console;
  console.quiet = common.quiet;
  console.verbose = common.verbose;
  const ThreadLimit limit(common.threads);
  Context context([&console](std::string_view stage, double fraction) { console.progress(stage, fraction); });
  const Interrupt interrupt(context);
  for (const Entry& entry : entries) {
    if (!entry.app->parsed()) continue;
    require_sound_paths(*entry.app);
    const ExitCode code = entry.command->run(console, context);
    return code == kInterrupted ? interrupt.exit_code() : code;
  }
  throw UsageError("command line", "no command is given", "see rejoin --help");
}

/// Whether a file goes to stdout (--json -), where no text may stand beside it.
bool file_on_stdout(const CLI::App& app) {
  const auto is_on_stdout = [](const CLI::Option* option) {
    return option->get_group() == "Output" && option->get_type_name() == "FILE" && !option->empty() &&
           is_stdout(option->results().back());
  };
  return std::ranges::any_of(app.get_options(), is_on_stdout) ||
         std::ranges::any_of(app.get_subcommands(),
                             [](const CLI::App* used) { return file_on_stdout(*used); });
}

/// What to do instead where a command got more arguments than it takes.
std::string hint_for(const std::string& command) {
  if (command == "rejoin batch" || command == "rejoin assemble") return " (name the folder of the scans)";
  if (command == "rejoin match") return " (rejoin batch matches all scans of a folder)";
  if (command == "rejoin outline match") return " (rejoin outline assemble takes all pieces of a folder)";
  return "";
}

/// What is wrong with the words that nothing takes.  CLI11 would list them all, back to front.
std::string unexpected(const std::vector<std::string>& words, const CLI::App& app,
                       const std::string& command) {
  const auto option = std::find_if(words.begin(), words.end(),
                                   [](const std::string& word) { return word.size() > 1 && word[0] == '-'; });
  if (option != words.end()) {
    std::error_code ignored;
    const bool is_file = std::filesystem::exists(*option, ignored);
    return fmt::format("{} is no option of {}{}", *option, command,
                       is_file ? fmt::format(" (the file is ./{})", *option) : "");
  }
  const std::vector<const CLI::App*> known = visible_subcommands(app);
  if (known.empty())
    return fmt::format("'{}' is one argument more than {} takes{}", words.front(), command,
                       hint_for(command));
  std::string names;
  for (const CLI::App* entry : known) names += (names.empty() ? "" : ", ") + entry->get_name();
  return fmt::format("'{}' is no command; there are {}", words.front(), names);
}

/// CLI11 tells an option that is repeated by "At Most 1 required but received 2".
std::string in_words(const std::string& problem) {
  constexpr std::string_view kRepeated = ": At Most 1 required but received ";
  const std::size_t at = problem.rfind(kRepeated);
  if (at == std::string::npos) return problem;
  const std::string times = problem.substr(at + kRepeated.size());
  return fmt::format("{} is given {}", problem.substr(0, at), times == "2" ? "twice" : times + " times");
}

/// What is wrong with the command line, as one line with the way out.
int explain(const CLI::App& root, const CLI::ParseError& error) {
  const CLI::App* app = &root;
  std::string command = "rejoin";
  for (auto used = root.get_subcommands(); !used.empty(); used = app->get_subcommands()) {
    app = used[0];
    command += " " + app->get_name();
  }
  const std::vector<std::string> words = root.remaining(true);
  const bool is_help = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);  // or --version
  if (is_help && (words.empty() || visible_subcommands(*app).empty()))
    return root.exit(error) == 0 ? kDone : kFailure;
  std::string text = words.empty() ? in_words(error.what()) : unexpected(words, *app, command);
  std::replace(text.begin(), text.end(), '\n', ' ');  // CLI11 tells several things on several lines
  std::fputs(fmt::format("rejoin: {}; see {} --help\n", harmless(text), command).c_str(), stderr);
  return kWrongUse;
}

int fail(const std::string& text, ExitCode code) {
  std::fputs(fmt::format("rejoin: {}\n", harmless_line(text)).c_str(), stderr);
  return code;
}

/// The words after the program's name; "help" before a command is its --help.
std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + std::max(1, argc));
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  words.emplace_back("--help");
  return words;
}

int run_program(int argc, char** argv) {
  CLI::App root("Finds how two scanned fragments join.", "rejoin");
  Common common;
  add_common(root, common);
  const std::vector<Entry> entries = add_commands(root);
  try {
    std::vector<std::string> words = words_of(argc, argv);
    std::ranges::reverse(words);  // as CLI11 takes them
    root.parse(std::move(words));
    common.quiet = common.quiet || file_on_stdout(root);
    return run(entries, common);
  } catch (const CLI::ParseError& error) {
    return explain(root, error);
  } catch (const UsageError& error) {
    return fail(error.what(), kWrongUse);
  }
}

/// Results that nobody can have read must not look like success: a full disk shows when the last bytes are written.
int with_results_written(int code) {
  std::cout.flush();
  std::fflush(stdout);
  if (reader_is_gone()) end_without_reader();
  if (code != kDone || (std::ferror(stdout) == 0 && std::cout.good())) return code;
  return fail("standard output: cannot be written; the results are not whole", kFailure);
}

}  // namespace
}  // namespace rejoin::cli

int main(int argc, char** argv) {
  using namespace rejoin::cli;
  outlive_reader();
  std::signal(SIGXFSZ, SIG_IGN);  // what is larger than `ulimit -f` cannot be written, as on a full disk
  try {
    return with_results_written(run_program(argc, argv));
  } catch (const rejoin::Error& error) {
    if (reader_is_gone() && !std::cout.good()) end_without_reader();  // this is what the error tells
    return fail(error.what(), kFailure);
  } catch (const std::bad_alloc&) {
    return fail("out of memory; use a smaller scan", kFailure);
  } catch (const std::exception& error) {
    return fail(std::string("internal error: ") + error.what(), kFailure);
  }
}
