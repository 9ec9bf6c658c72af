/// rejoin report
#include <fmt/core.h>

#include <filesystem>
#include <optional>
#include <system_error>

#include "cli/arguments.hpp"
#include "cli/command.hpp"
#include "cli/outputs.hpp"
#include "cli/run_report.hpp"
#include "core/files.hpp"
#include "store/run.hpp"

namespace rejoin::cli {
namespace {

class ReportCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("RUN", run_, "folder of rejoin batch, and of assemble after it")
        ->required()
        ->group("Input");
    app.add_option("--out", out_, "the page (RUN/report.html; -: to stdout)")
        ->type_name("FILE")
        ->group("Output");
    app.option_defaults()->group("Size");
    add_number(app, "--pictures", options_.pictured_joins, {0, 10000},
               "joins that get pictures, 0 to 10000 (60)");
    add_number(app, "--faces", options_.fragment_faces, {64, 1e6},
               "faces a fragment in 3D, 64 to 1000000 (16000)");
  }

  ExitCode run(Console& console, Context& context) override {
    static_cast<void>(store::Run::open(run_));  // what is no run is told as that, not as a place for its page
    const std::filesystem::path out =
        out_ ? std::filesystem::path(*out_) : store::folder_of(run_) / "report.html";
    require_apart_from_run("--out", out, store::folder_of(run_), "");
    require_writable_file(out);
    const report::RunReport report = read_run(run_, options_.listed_pairs, console, context);
    const bool written = !context.cancelled() && report::write_run_report(report, out, context, options_);
    console.end_progress();
    if (!written) {
      console.warning("interrupted; no page was written");
      return kInterrupted;
    }
    std::error_code none;  // of a pipe
    const auto size = static_cast<double>(std::filesystem::file_size(out, none));
    console.result(
        fmt::format("wrote {}{}\n", out.string(), none ? "" : fmt::format(" ({:.1f} MB)", size / 1e6)));
    return kDone;
  }

 private:
  std::string run_;
  std::optional<std::string> out_;
  report::RunReportOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_report_command() {
  return std::make_unique<ReportCommand>();
}

}  // namespace rejoin::cli
