/// rejoin compare
#include "match/compare.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/command.hpp"
#include "cli/fragment.hpp"
#include "cli/interrupt.hpp"
#include "cli/outputs.hpp"
#include "cli/pose_file.hpp"
#include "core/files.hpp"
#include "report/compare_report.hpp"

namespace rejoin::cli {
namespace {

class CompareCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("A", path_a_, "scan: ply, obj, stl, off, gltf, glb, drc, xyz or pts")
        ->required()
        ->group("Input");
    app.add_option("B", path_b_, "scan of the other fragment")->required()->group("Input");
    app.add_option("--pose", pose_, "B's coordinates to A's: JSON or 4 x 4 numbers")
        ->type_name("FILE")
        ->required()
        ->group("Input");
    app.add_option("--facets", painted_, "facets painted on A or B, may be repeated")
        ->type_name("FILE")
        ->expected(1)
        ->take_all()
        ->group("Input");
    add_solid(app, solid_);
    app.add_option("--json", json_, "write all figures (-: to stdout)")->type_name("FILE")->group("Output");
    app.add_option("--out", out_, "write compare.png and compare.json")->type_name("DIR")->group("Output");
    app.option_defaults()->group("Measurement");
    add_number(app, "--resolution", options_.resolution, {8, 2048},
               "pixels across a depth map, 8 to 2048 (128)");
    add_choice(app, "--backend", options_.drawing, backend_choices(), "what draws");
    add_number(app, "--steps", options_.steps, {0, 3}, "poses each way in 5 directions, 0 to 3 (1)");
  }

  ExitCode run(Console& console, Context& context) override {
    require_two_files(path_a_, path_b_);
    if (out_) {  // first, for --json may lie in it
      require_apart_from_outputs("--json", json_,
                                 {std::filesystem::path(*out_) / report::kComparisonPicture});
      require_writable_folder(*out_);
    }
    if (json_) require_writable_file(*json_);
    std::string doubt;
    const Rigid pose = read_pose(pose_, path_a_, path_b_, doubt);
    if (!doubt.empty()) console.warning(doubt);
    match::Fragment a = load_fragment(path_a_, console, context, kind_of(solid_));
    match::Fragment b = load_fragment(path_b_, console, context, kind_of(solid_));
    use_painted_facets(painted_, {&a, &b}, console);
    const match::Comparison comparison = match::compare(a, b, pose, options_, context);
    console.end_progress();
    if (context.cancelled()) {
      console.warning("interrupted; nothing was written");
      return kInterrupted;
    }
    if (json_) write_file(*json_, report::compare_json(comparison, path_a_, path_b_));
    console.result(report::compare_table(comparison));
    if (json_) console.wrote(*json_);
    if (out_) {
      const NothingToSave guard;
      for (const auto& file : report::write_compare_outputs(*out_, comparison, path_a_, path_b_))
        console.wrote(file);
    }
    return kDone;
  }

 private:
  std::string path_a_;
  std::string path_b_;
  std::string pose_;
  std::vector<std::string> painted_;
  bool solid_ = false;
  std::optional<std::string> json_;
  std::optional<std::string> out_;
  match::CompareOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_compare_command() {
  return std::make_unique<CompareCommand>();
}

}  // namespace rejoin::cli
