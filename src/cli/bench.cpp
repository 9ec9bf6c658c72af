/// rejoin bench
#include <fmt/core.h>

#include <fstream>
#include <optional>
#include <thread>

#include "cli/arguments.hpp"
#include "cli/command.hpp"
#include "cli/json_values.hpp"
#include "core/files.hpp"
#include "zbuffer/benchmark.hpp"

namespace rejoin::cli {
namespace {

using Rows = std::vector<zbuffer::BenchmarkRow>;

/// The processor's name as Linux tells it, with the number of cores.
std::string machine() {
  std::string name = "unknown processor";
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) != 0 || colon == std::string::npos) continue;
    name = line.substr(colon + 2);
    break;
  }
  return fmt::format("{}, {} cores", name, std::thread::hardware_concurrency());
}

/// What a row is compared with: our rasteriser on one thread at the same resolution; 0 if that was not
/// measured.
double baseline(const Rows& rows, int resolution) {
  for (const zbuffer::BenchmarkRow& row : rows) {
    if (row.backend == zbuffer::Backend::Raster && row.threads == 1 && row.resolution == resolution) {
      return row.evaluations_per_second;
    }
  }
  return 0.0;
}

std::string table(const Rows& rows) {
  std::string text = fmt::format("{:<10} {:>7} {:>7} {:>8} {:>14} {:>8}  {}\n", "backend", "pixels", "faces",
                                 "threads", "evaluations/s", "ratio", "renderer");
  for (const zbuffer::BenchmarkRow& row : rows) {
    const double base = baseline(rows, row.resolution);
    text +=
        fmt::format("{:<10} {:>7} {:>7} {:>8} {:>14.0f} {:>8}  {}\n", zbuffer::name_of(row.backend),
                    row.resolution, row.faces, row.threads, row.evaluations_per_second,
                    base > 0 ? fmt::format("{:.2f}", row.evaluations_per_second / base) : "-", row.renderer);
  }
  return text + "ratio: to the rasteriser on one thread at the same resolution\n";
}

std::string to_json(const Rows& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const zbuffer::BenchmarkRow& row : rows) {
    list.push_back({{"backend", zbuffer::name_of(row.backend)},
                    {"resolution", row.resolution},
                    {"faces", row.faces},
                    {"threads", row.threads},
                    {"evaluations_per_second", row.evaluations_per_second},
                    {"renderer", row.renderer}});
  }
  const nlohmann::ordered_json json = {{"schema", "rejoin.bench/1"}, {"machine", machine()}, {"rows", list}};
  return text_of(json);
}

class BenchCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("--json", json_, "write the table as JSON")->type_name("FILE")->group("Output");
    app.option_defaults()->group("Measurement");
    add_choice(app, "--backend", backend_, backend_choices(), "only this one");
    app.add_option("--resolution", options_.resolutions, "pixels across a depth map (64,128,256)")
        ->type_name("N,N,...")
        ->delimiter(',')
        ->expected(1)
        ->check(in_range(8, 2048));
    app.add_option("--faces", options_.faces, "faces a fragment (10000)")
        ->type_name("N")
        ->check(in_range(12, 1e7));
    app.add_option("--seconds", options_.seconds_per_row, "measured time a row (0.5)")
        ->type_name("S")
        ->check(in_range(0.001, 60));
  }

  ExitCode run(Console& console, Context& context) override {
    if (json_) require_writable_file(*json_);
    if (backend_ != zbuffer::Backend::Auto) options_.backends = {backend_};
    const Rows rows = zbuffer::benchmark(options_, context);
    if (json_) write_file(*json_, to_json(rows));
    console.result(machine() + "\n" + table(rows));
    return context.cancelled() ? kInterrupted : kDone;
  }

 private:
  std::optional<std::string> json_;
  zbuffer::Backend backend_ = zbuffer::Backend::Auto;
  zbuffer::BenchmarkOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_bench_command() {
  return std::make_unique<BenchCommand>();
}

}  // namespace rejoin::cli
