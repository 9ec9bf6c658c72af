/// rejoin match
#include "match/match.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/command.hpp"
#include "cli/fragment.hpp"
#include "cli/interrupt.hpp"
#include "cli/match_json.hpp"
#include "cli/match_options.hpp"
#include "cli/output_stage.hpp"
#include "cli/outputs.hpp"
#include "cli/pose_file.hpp"
#include "core/files.hpp"
#include "match/units.hpp"
#include "mesh/save.hpp"
#include "report/match_pictures.hpp"
#include "rims/propose.hpp"

namespace rejoin::cli {
namespace {

constexpr const char* kUnfinished =
    "interrupted before the search was finished: verdict and score, of the best pose so far, are no finding";

const Choices<bool> kProposers = {{"facets", false}, {"rims", true}};

void require_facets(const char* option, const std::vector<int>& numbers, const match::Fragment& fragment) {
  const int count = static_cast<int>(fragment.facets.facets.size());
  for (const int number : numbers) {
    if (number < count) continue;
    throw UsageError(
        option,
        fmt::format("{} has {} facets, numbered from 0; there is no {}", fragment.path, count, number),
        "see rejoin facets " + fragment.path);
  }
}

std::string pose_text(const Rigid& pose) {
  std::string text = "pose (B's coordinates to A's):\n";
  for (int row = 0; row < 3; ++row) {
    text += fmt::format("  {:15.12f} {:15.12f} {:15.12f} {:19.15g}\n", pose.rotation[0][row],
                        pose.rotation[1][row], pose.rotation[2][row], pose.translation[row]);
  }
  return text;
}

std::string measured(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : std::string("not measured");
}

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.0f} %", 100.0 * share) : std::string("not measured");
}

/// \param near  whether poses near a rough one alone were looked at
std::string summary(const match::Result& result, bool near) {
  if (result.candidates.empty()) {
    if (result.cancelled) return "interrupted before a pose was found\n";
    return near ? "no join, no pose near the rough one fits\n" : "no join, no pose was found\n";
  }
  const match::Candidate& best = result.candidates.front();
  const match::JointError& error = best.error;
  return fmt::format("{}{}, score {:.3f}\n", name_of(result.verdict),
                     result.cancelled ? " so far (the search is not finished)" : "", best.score) +
         (result.against.empty() ? "" : "against it: " + result.against + "\n") + pose_text(best.pose) +
         fmt::format("contact: area {:.4g}, median gap {}, penetration {:.3g} (in the scans' unit)\n",
                     error.contact_area, measured(error.gap_median, 3), error.penetration) +
         fmt::format("whole fragments: slope difference {}, ray-cast {}, overlap {}\n",
                     measured(error.slope, 4), measured(error.raycast, 4), percent(error.overlap));
}

/// What to tell of sizes that no two pieces of one object have; empty: nothing.
std::vector<std::string> doubts_about_units(const match::Fragment& a, const match::Fragment& b) {
  const auto groups = match::units_apart({match::lengths_of(a), match::lengths_of(b)});
  if (groups) {
    const bool a_is_small = groups->small.front() == 0;
    const std::string& small = (a_is_small ? a : b).path;
    const std::string& large = (a_is_small ? b : a).path;
    const auto units = match::likely_units(groups->ratio);
    return {fmt::format(
        "{}: every length (diameter, points' spacing, noise, wall) is about {:.0f} times those of "
        "{}; are both in the same unit{}?",
        large, groups->ratio, small,
        units ? fmt::format(", not this one in {} and the other in {}", units->of_large, units->of_small)
              : "")};
  }
  if (!match::units_differ(a.diameter, b.diameter)) return {};
  return {fmt::format("{} has a diameter of {:.3g}, {} of {:.3g}: are both in the same unit?", a.path,
                      a.diameter, b.path, b.diameter)};
}

class MatchCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("A", path_a_, "scans (ply obj stl off gltf glb drc xyz pts); B moves")
        ->required()
        ->group("Input");
    app.add_option("B", path_b_)->required()->group("Input");
    app.add_option("--json", json_, "write pose, score and measures (-: to stdout)")
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--out", out_, "write the joined model and pictures")->type_name("DIR")->group("Output");
    app.add_option("--facets", painted_, "facets painted on A or B, may be repeated")
        ->type_name("FILE")
        ->expected(1)
        ->take_all()
        ->group("Input");
    app.add_option("--near", near_, "look near a rough pose, as of --json or 4 x 4 numbers")
        ->type_name("FILE")
        ->group("Input");
    add_solid(app, solid_);
    app.option_defaults()->group("Search");
    add_choice(app, "--propose", by_rims_, kProposers, "what proposes poses; rims: of thin sherds");
    options_.define(app);
  }

  ExitCode run(Console& console, Context& context) override {
    const auto begin = std::chrono::steady_clock::now();
    match::Options options = options_.values();
    require_free_search(options);
    require_two_files(path_a_, path_b_);
    std::string doubt;
    if (near_) options.near = read_pose(*near_, path_a_, path_b_, doubt);
    if (!doubt.empty()) console.warning(doubt);
    if (out_) require_out();  // first, for --json may lie in it
    if (json_) require_writable_file(*json_);
    match::Fragment a = load_fragment(path_a_, console, context, kind_of(solid_));
    match::Fragment b = load_fragment(path_b_, console, context, kind_of(solid_));
    use_painted_facets(painted_, {&a, &b}, console);
    require_facets("--facets-a", options.facets_a, a);
    require_facets("--facets-b", options.facets_b, b);
    const std::vector<std::string> doubts = doubts_about_units(a, b);
    for (const std::string& doubt : doubts) console.warning(doubt);

    std::vector<StageTime> stages;
    if (by_rims_) {
      Stopwatch clock(stages);
      options.proposals = proposals(a, b, console, context);
      clock.lap("propose");
    }
    match::Result result = match::match(a, b, options, context);
    result.stages.insert(result.stages.begin(), stages.begin(), stages.end());
    console.end_progress();
    for (const std::string& warning : result.warnings) console.warning(warning);
    std::vector<std::string> told = a.warnings;
    told.insert(told.end(), b.warnings.begin(), b.warnings.end());
    told.insert(told.end(), doubts.begin(), doubts.end());
    result.warnings.insert(result.warnings.begin(), told.begin(), told.end());
    if (result.cancelled) {
      console.warning(kUnfinished);
      result.warnings.insert(result.warnings.begin(), kUnfinished);
    }
    tell_times(console, a, b, result);
    const double seconds = seconds_since(begin);
    if (json_ && result.cancelled && keeps_earlier(*json_, {*json_}, "match", console)) json_.reset();
    std::string json;
    if (json_) json = match_json(a, b, options, result, seconds);
    console.result(summary(result, near_.has_value()));
    if (out_) {
      write_all(console, a, b, result, json);
    } else {
      write_json(console, json);
    }
    return result.cancelled ? kInterrupted : kDone;
  }

 private:
  /// Rims propose whole poses: what restricts facets has nothing to restrict.
  void require_free_search(const match::Options& options) const {
    if (near_ && options.search == match::Search::Esa)
      throw UsageError("--near", "goes with --search sweep", "leave out one of the two");
    if (!by_rims_) return;
    if (options.search == match::Search::Esa) {
      throw UsageError("--propose rims", "goes with --search sweep", "leave out one of the two");
    }
    if (options.constraint == match::Constraint::Direction || !options.directions_a.empty() ||
        !options.directions_b.empty() || !options.facets_a.empty() || !options.facets_b.empty()) {
      throw UsageError("--propose rims", "takes no directions or facets", "leave out one of the two");
    }
  }

  void require_out() {
    std::vector<std::string> inputs = painted_;
    inputs.insert(inputs.end(), {path_a_, path_b_});
    const std::vector<std::filesystem::path> files = report::match_outputs(*out_);
    for (const std::filesystem::path& file : files) {
      for (const std::string& input : inputs) require_apart("--out", file, input);
    }
    require_apart_from_outputs("--json", json_, files);
    require_writable_folder(*out_);
    hold_.emplace(*out_);
  }

  std::vector<Rigid> proposals(const match::Fragment& a, const match::Fragment& b, Console& console,
                               const Context& context) const {
    std::vector<Rigid> poses;
    for (const rims::Proposal& proposal : rims::propose(a, b, {}, context)) poses.push_back(proposal.pose);
    if (poses.empty() && !context.cancelled())
      console.warning("the rims propose nothing (solid pieces have none); searching over facets");
    return poses;
  }

  void write_json(Console& console, const std::string& json) const {
    if (!json_) return;
    write_file(*json_, json);
    console.wrote(*json_);
  }

  bool any_earlier() const {
    std::vector<std::filesystem::path> files = report::match_outputs(*out_);
    if (json_) files.emplace_back(*json_);
    return std::ranges::any_of(files, [](const std::filesystem::path& file) {
      std::error_code ignored;
      return std::filesystem::exists(file, ignored);
    });
  }

  /// JSON and the folder's files, which take the place of earlier ones together.  Where there are none, the JSON comes first, as the
  /// others may be too large for the disk.
  void write_all(Console& console, const match::Fragment& a, const match::Fragment& b,
                 const match::Result& result, const std::string& json) const {
    const bool replaces = any_earlier();
    if (!replaces) write_json(console, json);
    const OutputStage stage(*out_);
    std::vector<std::filesystem::path> made;
    {
      const NothingToSave guard(replaces ? "interrupted; what an earlier match wrote stays" : "interrupted");
      made = make_files(console, stage.path(), a, b, result);
    }
    if (replaces) write_json(console, json);
    if (!result.cancelled) remove_others(made);
    for (const std::filesystem::path& file : stage.publish(made)) console.wrote(file);
  }

  std::vector<std::filesystem::path> make_files(Console& console, const std::filesystem::path& folder,
                                                const match::Fragment& a, const match::Fragment& b,
                                                const match::Result& result) const {
    if (!result.cancelled) return report::write_match_outputs(folder, a, b, result);
    if (keeps_earlier(*out_, report::match_outputs(*out_), "match", console) || result.candidates.empty())
      return {};
    // The joined model only: pictures take longer than a user who wants to stop will wait.
    const std::filesystem::path joined = folder / mesh::kJoinedPly;
    mesh::save_scene(joined,
                     {{path_a_, &a.surface, Rigid{}}, {path_b_, &b.surface, result.candidates[0].pose}});
    return {joined};
  }

  /// What an earlier match left besides would be taken for this one's.
  void remove_others(const std::vector<std::filesystem::path>& made) const {
    std::error_code ignored;
    for (const std::filesystem::path& file : report::match_outputs(*out_)) {
      const bool stays = std::ranges::any_of(
          made, [&](const std::filesystem::path& one) { return one.filename() == file.filename(); });
      if (!stays) std::filesystem::remove(file, ignored);
    }
  }

  static void tell_times(Console& console, const match::Fragment& a, const match::Fragment& b,
                         const match::Result& result) {
    for (const StageTime& time : stage_times(a, b, result)) {
      console.detail(fmt::format("{:<12} {:8.2f} s", time.stage, time.seconds));
    }
    console.detail(fmt::format("{} evaluations by {} ({})", result.evaluations,
                               zbuffer::name_of(result.backend), result.renderer));
  }

  std::string path_a_;
  std::string path_b_;
  std::vector<std::string> painted_;
  bool solid_ = false;
  std::optional<std::string> json_;
  std::optional<std::string> out_;
  std::optional<OutputHold> hold_;  ///< of out_
  std::optional<std::string> near_;
  bool by_rims_ = false;
  MatchOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_match_command() {
  return std::make_unique<MatchCommand>();
}

}  // namespace rejoin::cli
