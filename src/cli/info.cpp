/// rejoin info
#include <fmt/core.h>

#include <optional>
#include <thread>

#include "batch/batch.hpp"
#include "cli/command.hpp"
#include "cli/json_values.hpp"
#include "core/files.hpp"
#include "core/parallel.hpp"
#include "core/version.hpp"
#include "zbuffer/scorer.hpp"

namespace rejoin::cli {
namespace {

class InfoCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("--json", json_, "write the same as JSON (-: to stdout)")
        ->type_name("FILE")
        ->group("Output");
  }

  ExitCode run(Console& console, Context& /*context*/) override {
    if (json_) require_writable_file(*json_);
    const std::vector<zbuffer::BackendInfo> backends = zbuffer::list_backends();
    console.result(fmt::format("rejoin {}\nthreads {} of {}\n\nbackend    renderer\n", batch::version(),
                               thread_count(), std::thread::hardware_concurrency()));
    for (const zbuffer::BackendInfo& info : backends) {
      console.result(fmt::format("{:<10} {}\n", zbuffer::name_of(info.backend),
                                 info.available ? info.renderer : "missing: " + info.why_not));
    }
    if (json_) {
      write_file(*json_, to_json(backends));
      console.wrote(*json_);
    }
    return kDone;
  }

 private:
  static std::string to_json(const std::vector<zbuffer::BackendInfo>& backends) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const zbuffer::BackendInfo& info : backends) {
      list.push_back({{"name", zbuffer::name_of(info.backend)},
                      {"available", info.available},
                      {"renderer", info.renderer},
                      {"why_not", info.why_not}});
    }
    const nlohmann::ordered_json json = {{"schema", "rejoin.info/1"},
                                         {"version", kVersion},
                                         {"matcher", batch::matcher()},
                                         {"threads", thread_count()},
                                         {"cores", std::thread::hardware_concurrency()},
                                         {"backends", list}};
    return text_of(json);
  }

  std::optional<std::string> json_;
};

}  // namespace

std::unique_ptr<Command> make_info_command() {
  return std::make_unique<InfoCommand>();
}

}  // namespace rejoin::cli
