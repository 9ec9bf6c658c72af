/// What every subcommand is to main.cpp.
#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <string>

#include "cli/console.hpp"
#include "core/context.hpp"
#include "core/error.hpp"

namespace rejoin::cli {

/// Exit codes; users' scripts rely on them.  kInterrupted is that of Ctrl-C, other signals have others (Interrupt::exit_code()).
enum ExitCode { kDone = 0, kFailure = 1, kWrongUse = 2, kInterrupted = 130 };

/// The command line itself is wrong (exit code 2), as opposed to what it names.
class UsageError : public Error {
  using Error::Error;
};

/// One subcommand: its options and what it does with them.
class Command {
 public:
  virtual ~Command() = default;

  /// Adds the options to the subcommand; called once, before run().
  virtual void define(CLI::App& app) = 0;

  /// \return kDone, kInterrupted, or kFailure if it went on after failures and has told them; anything else leaves as an
  /// exception
  virtual ExitCode run(Console& console, Context& context) = 0;
};

std::unique_ptr<Command> make_match_command();
std::unique_ptr<Command> make_compare_command();
std::unique_ptr<Command> make_batch_command();
std::unique_ptr<Command> make_merge_command();
std::unique_ptr<Command> make_facets_command();
std::unique_ptr<Command> make_outline_command();
std::unique_ptr<Command> make_assemble_command();
std::unique_ptr<Command> make_shatter_command();
std::unique_ptr<Command> make_split_command();
std::unique_ptr<Command> make_report_command();
std::unique_ptr<Command> make_info_command();
std::unique_ptr<Command> make_bench_command();
/// Writes man pages and the bash completion of `root` (hidden; used by the build).
std::unique_ptr<Command> make_generate_docs_command(const CLI::App& root);

}  // namespace rejoin::cli
