/// rejoin assemble
#include "assembly/assembly.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "assembly/pairs.hpp"
#include "batch/inputs.hpp"
#include "cli/arguments.hpp"
#include "cli/assemble_constraints.hpp"
#include "cli/assemble_files.hpp"
#include "cli/assemble_input.hpp"
#include "cli/command.hpp"
#include "cli/hints.hpp"
#include "cli/interrupt.hpp"
#include "cli/output_stage.hpp"
#include "cli/outputs.hpp"
#include "core/files.hpp"
#include "core/words.hpp"
#include "store/run.hpp"

namespace rejoin::cli {
namespace {

/// Why a join is used whose score says too little.
const char* borne_by(const assembly::Join& join, const assembly::Options& options) {
  if (join.found || join.score >= options.sure) return "";
  const auto is_pinned = [&options](std::size_t k) {
    return std::ranges::any_of(options.constraints.pinned,
                               [k](const auto& numbered) { return numbered.first == k; });
  };
  if (is_pinned(join.a) && is_pinned(join.b)) return "; at the poses given";
  return assembly::among(options.constraints.must_join, join.a, join.b) ? "; as you said"
                                                                        : "; others bear it out";
}

std::string summary(const AssembleInput& input, const assembly::Result& result,
                    const assembly::Options& options) {
  std::size_t placed = 0;
  for (const assembly::Placement& placement : result.placements) placed += placement.group >= 0 ? 1 : 0;
  std::string text = fmt::format(
      "{} of {} placed, {}, {}\n", placed, counted(input.names.size() + input.bad.size(), "fragment"),
      counted(static_cast<std::size_t>(result.groups), "object"), counted(result.joins.size(), "join"));
  for (const assembly::Join& join : result.joins) {
    text += fmt::format("  {} + {}: {} {:.3f}, contact {:.4g}{}\n", input.names[join.a], input.names[join.b],
                        join.found ? "found by contact, score" : "score", join.score, join.contact_area,
                        borne_by(join, options));
  }
  for (std::size_t k = 0; k < input.names.size(); ++k) {
    if (result.placements[k].group >= 0) continue;
    text += fmt::format("  {} not placed: {}\n", input.names[k], reason_of(input, result, k));
  }
  if (result.groups == 0 && !result.cancelled && store::is_searched(input.remains))
    text += "  if some should join, see what counts as their breaks: rejoin facets FILE --png facets.png\n";
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
    hints_.define(app);
    app.add_option("--json", json_, "poses and joins here too (-: to stdout)")
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--out", out_, "models, transforms, a picture; for scans DIR/run too")
        ->type_name("DIR")
        ->group("Output");
    app.option_defaults()->group("Assembly");
    app.add_option("--sure", options_.sure, "score of a join that needs no witness, 0.5 to 1 (0.99)")
        ->type_name("P")
        ->check(in_range(0.5, 1.0));
  }

  ExitCode run(Console& console, Context& context) override {
    if (std::filesystem::path(input_).filename() == store::kFileName)
      input_ = store::folder_of(input_).string();
    require_outputs();
    const std::vector<std::filesystem::path> files = json_files(console);
    std::optional<std::filesystem::path> keep;
    if (out_) keep = kept_run();
    batch::Options matching;
    std::optional<ConstraintsFile> constraints;
    if (constraints_) {
      constraints = open_constraints(*constraints_);
      const KnownNames known = names_in(input_);
      read_constraints(*constraints, known.names, {}, known.copies);  // before hours of matching
    }
    hints_.read_into(matching, input_);
    AssembleInput input = read_assemble_input(input_, keep, matching, console, context);
    if (context.cancelled()) return stopped(console);
    require_no_loss(input, files);
    if (constraints) {
      AskedConstraints asked = read_constraints(*constraints, input.names, input.bad, input.copies);
      options_.constraints = std::move(asked.constraints);
      options_.without_pose = input.without_pose;
      for (const auto& [a, b] : options_.constraints.must_join)
        options_.without_pose.try_emplace(std::minmax(a, b), "they are not compared yet");
      input.left_out = std::move(asked.left_out);
      named_ = std::move(asked.named);
    }
    const assembly::Result result = assembly::assemble(input.fragments, input.links, options_, context);
    console.end_progress();
    for (const std::string& warning : warnings_of(input, result)) console.warning(warning);
    if (result.cancelled) console.warning("interrupted; what follows is less than possible");
    console.result(summary(input, result, options_));
    if (out_ && !result.cancelled) {
      write_all(files, input, result, console);
    } else {
      write_json(files, input, result, console);
    }
    if (result.cancelled) return kInterrupted;
    return input.failed_now || !input.lost.empty() ? kFailure : kDone;
  }

 private:
  std::filesystem::path kept_run() const { return std::filesystem::path(*out_) / "run"; }

  /// Matching a folder of scans takes long: what comes of it must have a place.
  void require_outputs() {
    std::error_code problem;
    if (!std::filesystem::exists(input_, problem)) {
      throw IoError(input_, "is not there", "give a run of rejoin batch, or the folder of the scans");
    }
    if (!is_run(input_)) static_cast<void>(batch::find_scans(input_));  // refuses what is no folder of scans
    if (!json_ && !out_ && !is_run(input_)) {
      throw UsageError(input_, "is no run, so nothing would be kept of its assembly",
                       "add --out DIR for all of it, or --json FILE for the poses alone");
    }
    if (hints_.given() != nullptr && is_run(input_)) {
      throw UsageError(hints_.given(), "serves a folder of scans, this is a run",
                       "give it to rejoin batch, or leave it out");
    }
    if (out_) {
      require_models_of_assembly(*out_);
      require_apart_from_outputs("--json", json_, model_files(*out_));
      require_writable_folder(*out_);  // before --json, which may lie in it
      hold_.emplace(*out_);
    }
    if (json_) {
      require_apart_from_run("--json", *json_,
                             is_run(input_) || !out_ ? std::filesystem::path(input_) : kept_run(),
                             kAssemblyName);
      require_writable_file(*json_);
    }
  }

  /// Where poses and joins go: into the run, where rejoin report looks for them, and where the user wants them.
  std::vector<std::filesystem::path> json_files(Console& console) const {
    std::vector<std::filesystem::path> files;
    if (json_) files.emplace_back(*json_);
    if (!out_ && !is_run(input_)) return files;
    const std::filesystem::path in_run =
        (is_run(input_) ? std::filesystem::path(input_) : kept_run()) / kAssemblyName;
    std::error_code ignored;
    if (json_ && std::filesystem::weakly_canonical(*json_, ignored) ==
                     std::filesystem::weakly_canonical(in_run, ignored))
      return files;
    try {
      require_writable_folder(in_run.parent_path());
      require_writable_file(in_run);
      files.push_back(in_run);
    } catch (const IoError& error) {
      if (!json_ && !(out_ && is_run(input_))) throw;
      console.warning(fmt::format("{}; rejoin report will not find this assembly{}", error.what(),
                                  json_ ? "" : " (--json FILE keeps its poses)"));
    }
    return files;
  }

  void write_json(const std::vector<std::filesystem::path>& files, const AssembleInput& input,
                  const assembly::Result& result, Console& console) const {
    for (const auto& file : files) {
      if (result.cancelled && std::filesystem::is_regular_file(file)) {
        console.warning(file.string() + " is kept as an earlier assembly wrote it");
        continue;
      }
      write_file(file, assembly_json(input, named_, result));
      console.wrote(file);
    }
  }

  /// Poses and models, which take the place of earlier ones together: poses beside other models would be taken for theirs.  Where there
  /// are none, poses come first, as models may be too large for the disk.
  void write_all(const std::vector<std::filesystem::path>& files, const AssembleInput& input,
                 const assembly::Result& result, Console& console) const {
    const bool any_earlier =
        has_models(*out_) || std::ranges::any_of(files, [](const std::filesystem::path& file) {
          std::error_code ignored;
          return std::filesystem::exists(file, ignored);
        });
    if (!any_earlier) write_json(files, input, result, console);
    if (result.groups == 0) console.result("nothing is placed, so there are no models to write\n");
    const OutputStage stage(*out_);
    std::vector<std::filesystem::path> models;
    {
      const NothingToSave guard(any_earlier ? "interrupted; what an earlier assembly wrote stays"
                                            : "interrupted");
      models = make_models(stage.path(), input, result);
    }
    if (any_earlier) write_json(files, input, result, console);
    remove_earlier(*out_, models);
    for (const auto& file : stage.publish(models)) console.wrote(file);
  }

  /// An assembly without scans that an earlier one could place must not replace it.
  static void require_no_loss(const AssembleInput& input, const std::vector<std::filesystem::path>& files) {
    if (input.lost.empty()) return;
    for (const std::filesystem::path& file : files) {
      std::error_code ignored;
      if (!std::filesystem::is_regular_file(file, ignored)) continue;
      throw InputError(file.string(),
                       fmt::format("is kept, as {} of the run cannot be used any more ({}{})",
                                   counted(input.lost.size(), "scan"), input.lost.front(),
                                   input.lost.size() == 1 ? "" : ", ..."),
                       "mend what the warnings say, or remove the file to assemble the others");
    }
  }

  ExitCode stopped(Console& console) const {
    console.end_progress();
    console.warning(out_ && !is_run(input_) ? "interrupted; the same command goes on where it stopped"
                                            : "interrupted");
    return kInterrupted;
  }

  std::string input_;
  std::optional<std::string> constraints_;
  std::optional<std::string> json_;
  std::optional<std::string> out_;
  std::optional<OutputHold> hold_;  ///< of out_
  NamedConstraints named_;          ///< what --constraints asks for
  Hints hints_;
  assembly::Options options_;
};

}  // namespace

std::unique_ptr<Command> make_assemble_command() {
  return std::make_unique<AssembleCommand>();
}

}  // namespace rejoin::cli
