/// rejoin outline calibrate
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "cli/arguments.hpp"
#include "cli/outline_calibration.hpp"
#include "cli/outline_command.hpp"
#include "cli/outputs.hpp"
#include "core/files.hpp"

namespace rejoin::cli {
namespace {

std::string table(const std::vector<outline::CalibratedLevel>& levels) {
  std::string text = "    step     xi   zeta  n_min   mistaken   true  false\n";
  for (const outline::CalibratedLevel& l : levels) {
    text +=
        fmt::format("{:8.4g} {:6.2f} {:6.2f} {:6.1f} {:8.1f} % {:6} {:6}\n", l.step, l.level.xi, l.level.zeta,
                    l.level.n_min, 100.0 * l.mistaken, l.true_candidates, l.false_candidates);
  }
  return text;
}

/// \throws InputError nothing was found for any scale, so that what would be written says nothing of the pieces
void require_calibrated(const std::vector<outline::CalibratedLevel>& levels, const std::string& joins) {
  if (std::ranges::any_of(levels, [](const outline::CalibratedLevel& l) { return l.calibrated; })) return;
  throw InputError(joins,
                   "no scale has ten places where its joins lie on each other and ten where pieces that do "
                   "not join resemble each other",
                   "give poses that lay the pieces side by side, and more pieces");
}

class OutlineCalibrateCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("DIR", folder_, "folder of pieces whose joins are known")->required()->group("Input");
    app.add_option("--joins", joins_, "assembly or truth as JSON (DIR/truth.json)")
        ->type_name("FILE")
        ->group("Input");
    app.add_option("--json", json_, "write the parameters (-: to stdout)")
        ->type_name("FILE")
        ->group("Output");
    add_picture_options(app, pictures_);
    add_number(app, "--scales", options_.scales, {1, 8}, "scales, 1 to 8 (5)")->group("Search");
    add_seed(app, options_.seed, "of the random numbers")->group("Search");
  }

  ExitCode run(Console& console, Context& context) override {
    const std::string path = joins_.value_or((std::filesystem::path(folder_) / "truth.json").string());
    if (json_) {
      require_apart("--json", *json_, path);
      require_writable_file(*json_);
    }
    const outline::PieceSet set = load_folder(folder_, pictures_, console, context);
    const std::vector<outline::KnownJoin> joins = read_known_joins(path, set.pieces);
    const std::vector<outline::CalibratedLevel> levels =
        outline::calibrate(set.pieces, joins, options_, context);
    console.end_progress();
    if (context.cancelled()) {
      console.warning("interrupted; nothing was written");
      return kInterrupted;
    }
    require_calibrated(levels, path);
    if (json_) write_file(*json_, calibration_json(levels, outline::told_resolution(set.pieces)));
    console.result(table(levels));
    if (json_) console.result(fmt::format("wrote {}\n", *json_));
    return finished_with(set, console);
  }

 private:
  std::string folder_;
  std::optional<std::string> joins_;
  std::optional<std::string> json_;
  outline::ExtractOptions pictures_;
  outline::CalibrateOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_outline_calibrate_command() {
  return std::make_unique<OutlineCalibrateCommand>();
}

}  // namespace rejoin::cli
