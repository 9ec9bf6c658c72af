/// rejoin assemble
#include "assembly/assembly.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <optional>

#include "cli/assemble_constraints.hpp"
#include "cli/assemble_files.hpp"
#include "cli/assemble_input.hpp"
#include "cli/command.hpp"
#include "cli/interrupt.hpp"
#include "core/files.hpp"

namespace rejoin::cli {
namespace {

std::string summary(const AssembleInput& input, const assembly::Result& result) {
  std::size_t placed = 0;
  for (const assembly::Placement& placement : result.placements) placed += placement.group >= 0 ? 1 : 0;
  std::string text = fmt::format("{} of {} fragments placed, {} {}, {} joins\n", placed,
                                 input.names.size() + input.bad.size(), result.groups,
                                 result.groups == 1 ? "object" : "objects", result.joins.size());
  for (const assembly::Join& join : result.joins) {
    text +=
        fmt::format("  {} + {}: {}, contact {:.4g}\n", input.names[join.a], input.names[join.b],
                    fmt::format("{} {:.3f}", join.found ? "found by contact, score" : "score", join.score),
                    join.contact_area);
  }
  for (std::size_t k = 0; k < input.names.size(); ++k) {
    if (result.placements[k].group >= 0) continue;
    text += fmt::format("  {} not placed: {}\n", input.names[k],
                        with_names(result.placements[k].reason, input.names));
  }
  for (const auto& [name, reason] : input.bad) text += fmt::format("  {} not placed: {}\n", name, reason);
  return text;
}

class AssembleCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("INPUT", input_, "a run of rejoin batch, or scans to match first")
        ->required()
        ->group("Input");
    app.add_option("--constraints", constraints_, "JSON: pairs that must or must not join, poses")
        ->type_name("FILE")
        ->group("Input");
    app.add_option("--json", json_, "write poses and joins (of a run: RUN/assembly.json)")
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--out", out_, "write models, transforms and a picture")
        ->type_name("DIR")
        ->group("Output");
    app.option_defaults()->group("Assembly");
    app.add_option("--sure", options_.sure, "score of a join that needs no witness, 0.5 to 1 (0.99)")
        ->type_name("P")
        ->check(CLI::Range(0.5, 1.0).description(""));
  }

  ExitCode run(Console& console, Context& context) override {
    if (!json_ && is_run(input_)) json_ = (std::filesystem::path(input_) / "assembly.json").string();
    if (json_) require_writable_file(*json_);
    if (out_) require_writable_folder(*out_);
    std::optional<std::filesystem::path> keep;
    if (out_) keep = std::filesystem::path(*out_) / "run";
    const AssembleInput input = read_assemble_input(input_, keep, console, context);
    if (context.cancelled()) return stopped(console);
    if (constraints_) options_.constraints = read_constraints(*constraints_, input.names);
    const assembly::Result result = assembly::assemble(input.fragments, input.links, options_, context);
    console.end_progress();
    for (const std::string& warning : result.warnings) console.warning(with_names(warning, input.names));
    if (result.cancelled) console.warning("interrupted; what follows is less than possible");
    if (json_) write_file(*json_, assembly_json(input, result));
    console.result(summary(input, result));
    if (json_) console.result(fmt::format("wrote {}\n", *json_));
    if (out_ && !result.cancelled) {
      const NothingToSave guard;
      for (const auto& file : write_assembly(*out_, input, result))
        console.result(fmt::format("wrote {}\n", file.string()));
    }
    return result.cancelled ? kInterrupted : kDone;
  }

 private:
  ExitCode stopped(Console& console) const {
    console.end_progress();
    console.warning(out_ ? "interrupted; the same command goes on where it stopped" : "interrupted");
    return kInterrupted;
  }

  std::string input_;
  std::optional<std::string> constraints_;
  std::optional<std::string> json_;
  std::optional<std::string> out_;
  assembly::Options options_;
};

}  // namespace

std::unique_ptr<Command> make_assemble_command() {
  return std::make_unique<AssembleCommand>();
}

}  // namespace rejoin::cli
