#include "report/compare_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "core/version.hpp"
#include "report/canvas.hpp"

namespace rejoin::report {
namespace {

using match::Comparison;
using match::GridPose;
using nlohmann::ordered_json;
using zbuffer::PairScore;

constexpr std::array<const char*, match::kPixelKinds> kKindNames{"silhouette", "steep", "interior"};

/// nlohmann writes NaN and infinity as null.
ordered_json score_json(const PairScore& score, int resolution) {
  return {{"depth", score.error},
          {"slope", static_cast<double>(score.error) * resolution},
          {"overlap_pixels", score.overlap},
          {"covered_a", score.covered_a},
          {"covered_b", score.covered_b}};
}

ordered_json pose_json(const GridPose& pose, int resolution) {
  return {{"angles_deg", pose.angles_deg},
          {"shift", pose.shift},
          {"drawn", score_json(pose.drawn, resolution)},
          {"cast", score_json(pose.cast, resolution)},
          {"cast_full", score_json(pose.cast_full, resolution)}};
}

ordered_json difference_json(const match::RenderingDifference& difference) {
  ordered_json kinds;
  for (std::size_t k = 0; k < match::kPixelKinds; ++k) {
    const match::KindShare& kind = difference.kinds[k];
    kinds[kKindNames[k]] = {{"pixels", kind.pixels},
                            {"depth_mean", kind.depth_mean},
                            {"depth_max", kind.depth_max},
                            {"depth_share", kind.depth_share},
                            {"error_share", kind.error_share}};
  }
  return {{"first", difference.first},
          {"second", difference.second},
          {"only_first", difference.only_first},
          {"only_second", difference.only_second},
          {"kinds", kinds}};
}

ordered_json agreement_json(const match::ErrorAgreement& agreement) {
  return {{"poses", agreement.poses},
          {"mean", agreement.mean},
          {"max", agreement.max},
          {"relative", agreement.relative},
          {"correlation", agreement.correlation}};
}

/// As rejoin match's JSON has them; infinite values become null.
ordered_json joint_json(const match::Candidate& joint) {
  return {{"score", joint.score},
          {"contact_area", joint.error.contact_area},
          {"gap_median", joint.error.gap_median},
          {"penetration", joint.error.penetration}};
}

std::string score_line(const char* name, const PairScore& score, int resolution) {
  return fmt::format("  {:<28}{:>12}{:>12}{:>12}{:>12}{:>12}\n", name,
                     short_number(static_cast<double>(score.error) * resolution), short_number(score.error),
                     score.overlap, score.covered_a, score.covered_b);
}

std::string difference_lines(const match::RenderingDifference& difference) {
  std::string text = fmt::format("  {} - {}\n", difference.first, difference.second);
  text +=
      fmt::format("  covered by one only: {} / {} pixels\n", difference.only_first, difference.only_second);
  text += fmt::format("    {:<12}{:>10}{:>14}{:>14}{:>16}{:>16}\n", "pixels", "number", "depth mean",
                      "depth max", "share of depth", "share of error");
  for (std::size_t k = 0; k < match::kPixelKinds; ++k) {
    const match::KindShare& kind = difference.kinds[k];
    text += fmt::format("    {:<12}{:>10}{:>14}{:>14}{:>14.1f} %{:>14.1f} %\n", kKindNames[k], kind.pixels,
                        short_number(kind.depth_mean), short_number(kind.depth_max), 100 * kind.depth_share,
                        100 * kind.error_share);
  }
  return text;
}

std::string agreement_line(const char* name, const match::ErrorAgreement& agreement) {
  return fmt::format("  {:<28}{:>12}{:>12}{:>10} %{:>12}\n", name, short_number(agreement.mean),
                     short_number(agreement.max), short_number(100 * agreement.relative),
                     agreement.poses > 1 ? fmt::format("{:.4f}", agreement.correlation) : "-");
}

}  // namespace

std::string compare_table(const Comparison& comparison) {
  const int n = comparison.resolution;
  const match::JointError& joint = comparison.joint.error;
  std::string text = fmt::format(
      "joint at the pose as it stands, in the scans' unit\n"
      "  score {:.3f}, contact area {}, median gap {}, penetration {}\n\n",
      comparison.joint.score, short_number(joint.contact_area), short_number(joint.gap_median),
      short_number(joint.penetration));
  text += fmt::format("slope difference of the whole fragments at the pose, {} x {} pixels\n", n, n);
  text += fmt::format("  {:<28}{:>12}{:>12}{:>12}{:>12}{:>12}\n", "", "slope", "depth", "overlap", "A covers",
                      "B covers");
  text += score_line("drawn, coarse", comparison.pose.drawn, n);
  text += score_line("ray cast, coarse", comparison.pose.cast, n);
  text += score_line("ray cast, full", comparison.pose.cast_full, n);
  text += "\nfrom drawing\n" + difference_lines(comparison.drawing);
  text += "\nfrom the level of detail\n" + difference_lines(comparison.detail);
  if (comparison.grid.size() < 2) return text;
  text += fmt::format("\nover {} poses around it, slope\n", comparison.grid.size());
  text += fmt::format("  {:<28}{:>12}{:>12}{:>12}{:>12}\n", "|difference|", "mean", "largest", "of the mean",
                      "correlation");
  text += agreement_line("drawing", comparison.drawing_agreement);
  text += agreement_line("level of detail", comparison.detail_agreement);
  text += agreement_line("both", comparison.total_agreement);
  return text;
}

std::string compare_json(const Comparison& comparison, const std::string& path_a, const std::string& path_b) {
  const int n = comparison.resolution;
  ordered_json grid = ordered_json::array();
  for (const GridPose& pose : comparison.grid) grid.push_back(pose_json(pose, n));
  const auto slope = [n](const PairScore& score) { return static_cast<double>(score.error) * n; };
  const GridPose& pose = comparison.pose;
  const ordered_json json = {{"schema", "rejoin.compare/1"},
                             {"a", path_a},
                             {"b", path_b},
                             {"resolution", n},
                             {"view_side", comparison.view.view_side},
                             {"renderer", comparison.renderer},
                             {"reference", comparison.caster},
                             {"joint", joint_json(comparison.joint)},
                             {"pose", pose_json(pose, n)},
                             {"explained",
                              {{"total", slope(pose.drawn) - slope(pose.cast_full)},
                               {"drawing", slope(pose.drawn) - slope(pose.cast)},
                               {"detail", slope(pose.cast) - slope(pose.cast_full)}}},
                             {"drawing", difference_json(comparison.drawing)},
                             {"detail", difference_json(comparison.detail)},
                             {"agreement",
                              {{"drawing", agreement_json(comparison.drawing_agreement)},
                               {"detail", agreement_json(comparison.detail_agreement)},
                               {"total", agreement_json(comparison.total_agreement)}}},
                             {"grid", grid},
                             {"version", kVersion}};
  // A file name may be no UTF-8; the JSON must be.
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::vector<std::filesystem::path> write_compare_outputs(const std::filesystem::path& folder,
                                                         const Comparison& comparison,
                                                         const std::string& path_a,
                                                         const std::string& path_b) {
  require_writable_folder(folder);
  const auto name = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
  std::vector<std::filesystem::path> files{folder / "compare.json", folder / kComparisonPicture};
  write_file(files[0], compare_json(comparison, path_a, path_b));
  write_png(files[1], draw_comparison(comparison, name(path_a), name(path_b)));
  return files;
}

}  // namespace rejoin::report
