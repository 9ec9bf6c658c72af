/// rejoin outline match
#include <fmt/core.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/outline_command.hpp"
#include "cli/outline_json.hpp"
#include "cli/outline_rims.hpp"
#include "cli/outputs.hpp"
#include "core/files.hpp"
#include "core/png_mark.hpp"
#include "mesh/load.hpp"
#include "outline/congruence.hpp"
#include "outline/stitch.hpp"
#include "report/outline_pictures.hpp"

namespace rejoin::cli {
namespace {

std::string verdict_of(const outline::PairResult& result) {
  return outline_verdict(result.candidates.empty() ? 0.0 : result.candidates.front().score);
}

/// Where a boundary is that runs along a hole.
const char* place_of(const outline::Boundary& boundary) {
  if (boundary.hole_a > 0) return " (B lies in a hole of A)";
  return boundary.hole_b > 0 ? " (A lies in a hole of B)" : "";
}

std::string summary(const outline::Piece& a, const outline::Piece& b, const outline::PairResult& result) {
  if (result.candidates.empty()) return "no join, nothing fits\n";
  const outline::JoinCandidate& best = result.candidates.front();
  const glm::dmat3 m = outline::matrix(best.pose);
  std::string text = fmt::format("{}, score {:.3f}\n", outline_verdict(best.score), best.score);
  text += best.pose.flipped ? "pose (B turned over, B's coordinates to A's):\n"
                            : "pose (B's coordinates to A's):\n";
  for (int row = 0; row < 3; ++row)
    text += fmt::format("  {:12.8f} {:12.8f} {:16.10g}\n", m[0][row], m[1][row], m[2][row]);
  const outline::JoinAreas areas = outline::join_areas(a.outline, b.outline, best);
  return text +
         fmt::format(
             "common boundary{}: length {:.4g}, gap area {:.4g}, overlap area {:.4g} (in the files' unit)\n",
             place_of(best.boundary), best.boundary.length, areas.gap, areas.overlap);
}

class OutlineMatchCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("A", path_a_, "png, jpg, tif, csv, svg, geojson, or a scan")->required()->group("Input");
    app.add_option("B", path_b_, "piece that is moved; FILE#2: the second in FILE")
        ->required()
        ->group("Input");
    app.add_option("--json", json_, "write pose, score and boundary (-: to stdout)")
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--out", out_, "write match.png and joined.png")->type_name("DIR")->group("Output");
    add_outline_method(app, method_);
    add_calibration(app, calibration_);
    add_picture_options(app, pictures_);
  }

  ExitCode run(Console& console, Context& context) override {
    const auto begin = std::chrono::steady_clock::now();
    const PieceName a = piece_name(path_a_);
    const PieceName b = piece_name(path_b_);
    if (a.number == b.number) require_two_files(a.file, b.file);
    if (mesh::has_scan_name(path_a_) || mesh::has_scan_name(path_b_)) return run_rims(console, context);
    outline::MultiscaleOptions multiscale;
    search_pairs_in_full(1, multiscale);
    apply_calibration(calibration_, method_, multiscale);
    if (out_) require_out(a.file, b.file);  // first, for --json may lie in it
    if (json_) require_json(a.file, b.file);
    const std::vector<outline::Piece> pieces{load_piece(a, pictures_, console),
                                             load_piece(b, pictures_, console)};
    if (const auto doubt = outline::doubt_resolutions({a.file, b.file})) console.warning(*doubt);
    if (const auto doubt = outline::doubt_axes(pieces)) console.warning(*doubt);
    check_calibration(calibration_, multiscale, pieces, console);
    check_holes(method_, pieces, console);
    console.detail(fmt::format("read both pieces in {:.2f} s", seconds_since(begin)));
    const std::unique_ptr<outline::Matcher> matcher = make_matcher(method_, multiscale);
    context.report("comparing outlines", 0.0);
    matcher->prepare(pieces);
    const bool congruent = outline::congruent(pieces[0].outline, pieces[1].outline);
    const outline::PairResult result = congruent ? outline::PairResult{} : matcher->match(0, 1, context);
    const double seconds = seconds_since(begin);
    console.end_progress();
    console.detail(fmt::format("compared by {} after {:.2f} s, {} candidates", name_of(method_), seconds,
                               result.candidates.size()));
    if (congruent) {
      console.warning(
          fmt::format("{} and {} are the same piece, or cut to one shape: their outlines are congruent",
                      pieces[0].name, pieces[1].name));
    } else if (outline::congruent(outline::turned_over(pieces[0].outline), pieces[1].outline)) {
      console.warning(
          fmt::format("{} and {} may be two sides of one piece: turned over, one has the other's outline",
                      pieces[0].name, pieces[1].name));
    }
    const bool cancelled = context.cancelled();
    if (cancelled) console.warning("interrupted; what follows is the best so far");
    if (json_ && cancelled && keeps_earlier(*json_, {*json_}, "match", console)) json_.reset();
    if (json_) {
      const OutlineSearch search{name_of(method_), seconds, cancelled};
      write_file(*json_, outline_match_json(pieces[0], pieces[1], result, search));
    }
    console.result(summary(pieces[0], pieces[1], result));
    if (json_) console.result(fmt::format("wrote {}\n", *json_));
    if (out_ && cancelled) keeps_earlier(*out_, report::outline_match_pictures(*out_), "match", console);
    if (out_ && !cancelled) {
      remove_earlier();
      for (const std::filesystem::path& file :
           report::write_outline_match_pictures(*out_, pieces[0], pieces[1], result, verdict_of(result)))
        console.result(fmt::format("wrote {}\n", file.string()));
    }
    return cancelled ? kInterrupted : kDone;
  }

 private:
  void require_json(const std::string& a, const std::string& b) const {
    require_apart("--json", *json_, a);
    require_apart("--json", *json_, b);
    require_writable_file(*json_);
  }

  void require_out(const std::string& a, const std::string& b) const {
    const std::vector<std::filesystem::path> pictures = report::outline_match_pictures(*out_);
    require_apart_from_outputs("--json", json_, pictures);
    require_writable_folder(*out_);
    for (const std::filesystem::path& file : pictures) {
      require_apart("--out", file, a);
      require_apart("--out", file, b);
      std::error_code ignored;
      if (std::filesystem::exists(file, ignored) && !is_marked_png_file(file))
        throw UsageError(file.string(), "is no picture of this program and would be lost",
                         "give --out another place");
    }
  }

  /// The pictures of an earlier pair would be taken for those of this one.
  void remove_earlier() const {
    std::error_code ignored;
    for (const std::filesystem::path& file : report::outline_match_pictures(*out_))
      std::filesystem::remove(file, ignored);
  }

  ExitCode run_rims(Console& console, Context& context) {
    if (!mesh::has_scan_name(path_a_) || !mesh::has_scan_name(path_b_))
      throw UsageError("A B", "one is a scan and the other is flat", "give two of a kind");
    const bool dust = pictures_.dust != outline::ExtractOptions{}.dust;
    if (out_ || calibration_ || dust || pictures_.keep_core || pictures_.keep_threads ||
        pictures_.part_touching || method_ != OutlineMethod::Automatic) {
      throw UsageError(out_                      ? "--out"
                       : calibration_            ? "--calibration"
                       : dust                    ? "--dust"
                       : pictures_.keep_core     ? "--keep-core"
                       : pictures_.keep_threads  ? "--keep-threads"
                       : pictures_.part_touching ? "--part-touching"
                                                 : "--method",
                       "is for flat pieces, and these are scans", "leave it out, or use rejoin match");
    }
    if (json_) require_writable_file(*json_);
    return match_rims(path_a_, path_b_, json_, console, context);
  }

  std::string path_a_;
  std::string path_b_;
  std::optional<std::string> json_;
  std::optional<std::string> out_;
  std::optional<std::string> calibration_;
  outline::ExtractOptions pictures_;
  OutlineMethod method_ = OutlineMethod::Automatic;
};

}  // namespace

std::unique_ptr<Command> make_outline_match_command() {
  return std::make_unique<OutlineMatchCommand>();
}

}  // namespace rejoin::cli
