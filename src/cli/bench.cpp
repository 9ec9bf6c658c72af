/// rejoin bench
#include <fmt/core.h>

#include <fstream>
#include <optional>
#include <thread>

#include "cli/arguments.hpp"
#include "cli/command.hpp"
#include "cli/json_values.hpp"
#include "core/files.hpp"
#include "core/version.hpp"
#include "zbuffer/benchmark.hpp"

namespace rejoin::cli {
namespace {

using Rows = std::vector<zbuffer::BenchmarkRow>;
using Ratios = std::vector<zbuffer::BenchmarkRatio>;

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

std::string table(const Rows& rows) {
  std::string text = fmt::format("{:<16} {:>6} {:>7} {:>7} {:>6} {:>13} {:>8}  {}\n", "backend", "pixels",
                                 "faces", "threads", "batch", "evaluations/s", "/CPU s", "renderer");
  for (const zbuffer::BenchmarkRow& row : rows) {
    const auto backend = fmt::format("{} {}", zbuffer::name_of(row.backend), row.way);
    const auto batch = row.batch > 0 ? std::to_string(row.batch) : "-";
    text += fmt::format("{:<16} {:>6} {:>7} {:>7} {:>6} {:>13.0f} {:>8.0f}  {}\n", backend, row.resolution,
                        row.faces, row.threads, batch, row.evaluations_per_second,
                        row.evaluations_per_cpu_second, row.renderer);
  }
  return text;
}

std::string table(const Ratios& ratios) {
  std::string text;
  for (const zbuffer::BenchmarkRatio& ratio : ratios) {
    text += fmt::format("{} / {}, {} pixels, {} faces: {:.2f}\n", ratio.of, ratio.to, ratio.resolution,
                        ratio.faces, ratio.ratio);
  }
  return text;
}

std::string rows_json(const Rows& rows, const Ratios& ratios) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const zbuffer::BenchmarkRow& row : rows) {
    list.push_back({{"backend", zbuffer::name_of(row.backend)},
                    {"way", row.way},
                    {"resolution", row.resolution},
                    {"faces", row.faces},
                    {"threads", row.threads},
                    {"batch", row.batch},
                    {"evaluations_per_second", row.evaluations_per_second},
                    {"evaluations_per_cpu_second", row.evaluations_per_cpu_second},
                    {"renderer", row.renderer}});
  }
  nlohmann::ordered_json compared = nlohmann::ordered_json::array();
  for (const zbuffer::BenchmarkRatio& ratio : ratios) {
    compared.push_back({{"of", ratio.of},
                        {"to", ratio.to},
                        {"resolution", ratio.resolution},
                        {"faces", ratio.faces},
                        {"ratio", ratio.ratio}});
  }
  const nlohmann::ordered_json json = {{"schema", "rejoin.bench/1"},
                                       {"machine", machine()},
                                       {"rows", list},
                                       {"ratios", compared},
                                       {"version", kVersion}};
  return text_of(json);
}

/// \throws BackendError  with the reason why it cannot draw here
void require_available(zbuffer::Backend backend) {
  const mesh::Mesh least = zbuffer::bumpy_sphere(12, 1);
  zbuffer::make_scorer(backend, least, least, {});
}

class BenchCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("--json", json_, "write the table as JSON (-: to stdout)")
        ->type_name("FILE")
        ->group("Output");
    app.option_defaults()->group("Measurement");
    add_choice(app, "--backend", backend_, backend_choices(), "only this one");
    add_numbers(app, "--resolution", options_.resolutions, {8, 2048, "N,N,..."},
                "pixels across a depth map (64,128,256)");
    add_numbers(app, "--faces", options_.faces, {12, 1e7, "N,N,..."}, "faces a fragment (10000)");
    add_numbers(app, "--batch", options_.batches, {1, 1 << 20, "N,N,..."},
                "poses a call (grows until a call takes a while)");
    add_number(app, "--seconds", options_.seconds_per_row, {0.001, 60, "S"}, "measured time a row (0.5)");
  }

  ExitCode run(Console& console, Context& context) override {
    if (json_) require_writable_file(*json_);
    if (backend_ != zbuffer::Backend::Auto) {
      require_available(backend_);
      options_.backends = {backend_};
    }
    const Rows rows = zbuffer::benchmark(options_, context);
    const Ratios ratios = zbuffer::ratios_of(rows);
    if (json_) write_file(*json_, rows_json(rows, ratios));
    console.result(machine() + "\n" + table(rows) + table(ratios));
    if (json_) console.wrote(*json_);
    if (context.cancelled()) console.warning("interrupted; what was not measured has no row");
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
