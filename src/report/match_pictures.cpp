#include "report/match_pictures.hpp"

#include <fmt/format.h>

#include <array>
#include <system_error>

#include "core/files.hpp"
#include "mesh/save.hpp"
#include "report/convergence.hpp"
#include "report/depth_pictures.hpp"
#include "report/joint_maps.hpp"
#include "report/match_sheet.hpp"
#include "report/views.hpp"

namespace rejoin::report {
namespace {

constexpr const char* kConvergence = "convergence.svg";
constexpr const char* kSheet = "match.png";
constexpr std::array kDepthMaps{"depth_a.png", "depth_b.png", "depth_difference.png"};

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// The direction in which A faces B in the candidate's own view; used where the surfaces do not touch.
glm::dvec3 view_direction(const match::Candidate& candidate) {
  const glm::dmat3 turn(candidate.view.rotation_a);
  return glm::transpose(turn) * glm::dvec3(0, 0, 1);
}

Image draw_heights(const zbuffer::DepthMap& map, const JointMaps& maps, const MapWindow& window,
                   const std::string& title) {
  const auto [near, far] = robust_range(within_joint(map, maps.difference), 0.02);
  MapPicture style;
  style.title = title;
  style.note =
      fmt::format("height above the lowest 2 % of the joint; {} pixels across the whole view", map.width);
  style.unit = "[mesh units]";
  style.bar = {even_colour, 0, far > near ? static_cast<double>(far) - near : 1, false, ""};
  style.window = window;
  return draw_map(heights(map, far), style);
}

Image draw_difference(const JointMaps& maps, const match::JointError& error, const MapWindow& window) {
  MapPicture style;
  style.title = "Slope difference of A and B, whole fragments";
  style.note = difference_note(error, maps.score.overlap > 0);
  style.unit = "[slope]";
  style.bar = {difference_colour, 0, difference_scale(maps), false, ""};
  style.window = window;
  return draw_map(maps.difference, style);
}

/// \return the three files
std::vector<std::filesystem::path> write_depth_maps(const std::filesystem::path& folder, const Joint& joint,
                                                    const std::string& name_a, const std::string& name_b,
                                                    const match::JointError& error, int resolution) {
  const JointMaps maps = make_maps(joint, resolution);
  const MapWindow window = covered_window({&maps.a, &maps.b}, 4);
  std::vector<std::filesystem::path> files{folder / kDepthMaps[0], folder / kDepthMaps[1],
                                           folder / kDepthMaps[2]};
  write_png(files[0], draw_heights(maps.a, maps, window, "A  " + name_a + ", seen from B"));
  write_png(files[1], draw_heights(maps.b, maps, window, "B  " + name_b + ", seen from A, mirrored"));
  write_png(files[2], draw_difference(maps, error, window));
  return files;
}

/// The scan with its own colours, or else with the tint.
mesh::Mesh coloured(const mesh::Mesh& surface, Colour tint) {
  mesh::Mesh result = surface;
  if (result.colours.empty()) result.colours.assign(result.vertices.size(), tint);
  return result;
}

/// \return the two files
std::vector<std::filesystem::path> write_joined(const std::filesystem::path& folder, const match::Fragment& a,
                                                const match::Fragment& b, const Rigid& pose) {
  const mesh::Mesh first = coloured(a.surface, kTintA);
  const mesh::Mesh second = coloured(b.surface, kTintB);
  std::vector<std::filesystem::path> files{folder / mesh::kJoinedGlb, folder / mesh::kJoinedPly};
  for (const auto& file : files)
    mesh::save_scene(file, {{file_name(a.path), &first, Rigid{}}, {file_name(b.path), &second, pose}});
  return files;
}

/// What an earlier match left would be taken for this one's.
void remove_earlier(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const std::filesystem::path& file : match_outputs(folder)) std::filesystem::remove(file, ignored);
}

}  // namespace

std::string difference_note(const match::JointError& error, bool overlap) {
  if (!overlap) return "the two maps do not overlap";
  return fmt::format("dark where slopes agree; mean {}, walls behind the break included (depth error {})",
                     short_number(error.slope), short_number(error.depth));
}

std::vector<std::filesystem::path> match_outputs(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const char* name : {kConvergence, kSheet, mesh::kJoinedGlb, mesh::kJoinedPly})
    files.push_back(folder / name);
  for (const char* name : kDepthMaps) files.push_back(folder / name);
  return files;
}

std::vector<std::filesystem::path> write_match_outputs(const std::filesystem::path& folder,
                                                       const match::Fragment& a, const match::Fragment& b,
                                                       const match::Result& result,
                                                       const MatchOutputOptions& options) {
  require_writable_folder(folder);
  if (result.candidates.empty()) remove_earlier(folder);
  const std::string name_a = file_name(a.path);
  const std::string name_b = file_name(b.path);
  std::vector<std::filesystem::path> files{folder / kConvergence};
  write_file(files[0], convergence_svg(result, name_a + " and " + name_b));
  if (result.candidates.empty()) return files;
  const match::Candidate& best = result.candidates.front();
  const Joint joint =
      make_joint(a.surface, b.surface, best.pose, view_direction(best), std::max(a.resolution, b.resolution));
  files.push_back(folder / kSheet);
  const std::string backend = std::string(zbuffer::name_of(result.backend)) + " (" + result.renderer + ")";
  write_png(files.back(), draw_match_sheet(joint, {name_a, name_b, result.verdict, best, backend}));
  for (const auto& file : write_depth_maps(folder, joint, name_a, name_b, best.error, options.map_resolution))
    files.push_back(file);
  for (const auto& file : write_joined(folder, a, b, best.pose)) files.push_back(file);
  return files;
}

}  // namespace rejoin::report
