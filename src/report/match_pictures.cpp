#include "report/match_pictures.hpp"

#include <fmt/format.h>

#include <cmath>

#include "match/pose_space.hpp"
#include "mesh/save.hpp"
#include "report/convergence.hpp"
#include "report/depth_pictures.hpp"
#include "report/match_sheet.hpp"
#include "report/views.hpp"
#include "zbuffer/error.hpp"
#include "zbuffer/scorer.hpp"

namespace rejoin::report {
namespace {

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// Inferno-like: dark where the slopes agree, bright where they do not.
Colour difference_colour(double share) {
  static const std::array<Colour, 7> kStops{Colour{6, 6, 30},     Colour{58, 16, 102}, Colour{122, 32, 108},
                                            Colour{186, 54, 85},  Colour{231, 94, 45}, Colour{249, 161, 26},
                                            Colour{250, 236, 160}};
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(kStops.size() - 1);
  const auto first = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  return mix(kStops[first], kStops[first + 1], at - static_cast<double>(first));
}

/// The direction in which A faces B in the candidate's own view; used where the surfaces do not touch.
glm::dvec3 view_direction(const match::Candidate& candidate) {
  const glm::dmat3 turn(candidate.view.rotation_a);
  return glm::transpose(turn) * glm::dvec3(0, 0, 1);
}

void draw_height_map(const std::filesystem::path& path, const zbuffer::DepthMap& map,
                     const std::string& title) {
  const auto [near, far] = robust_range(map, 0.005);
  MapPicture style;
  style.title = title;
  style.note = fmt::format("height above the depth {} from the reference plane", short_number(far));
  style.unit = "[mesh units]";
  style.bar = {even_colour, 0, far > near ? far - near : 1, false, ""};
  write_png(path, draw_map(heights(map, far), style));
}

void draw_difference(const std::filesystem::path& path, const zbuffer::DepthMap& a,
                     const zbuffer::DepthMap& b, double view_side) {
  const zbuffer::DepthMap difference = zbuffer::slope_difference_map(a, b, view_side);
  const zbuffer::PairScore score = zbuffer::slope_difference(a, b, view_side);
  MapPicture style;
  style.title = "Slope difference at the joint";
  style.note =
      score.overlap == 0
          ? "the two maps do not overlap"
          : fmt::format("mean {} over {} pixels; as a share of the view a pixel step: {}",
                        short_number(score.error * a.width), score.overlap, short_number(score.error));
  style.unit = "[slope]";
  style.bar = {difference_colour, 0, round_up(std::max(1e-6, robust_range(difference, 0.05).second)), false,
               ""};
  write_png(path, draw_map(difference, style));
}

/// \return the three files
std::vector<std::filesystem::path> write_depth_maps(const std::filesystem::path& folder, const Joint& joint,
                                                    const std::string& name_a, const std::string& name_b,
                                                    int resolution) {
  zbuffer::ViewOptions view;
  view.resolution = resolution;
  view.view_side = 1.3 * std::max(mesh::diameter(joint.a), mesh::diameter(joint.b));
  view.centre_a = match::view_centre(joint.a);
  view.centre_b = match::view_centre(joint.b);
  const match::ViewCentres centres{joint.a.origin + glm::dvec3(view.centre_a),
                                   joint.b.origin + glm::dvec3(view.centre_b)};
  const match::FacingView facing = match::facing_view(joint.pose, joint.normal, centres);
  const auto scorer = zbuffer::make_scorer(zbuffer::Backend::Raster, joint.a, joint.b, view);
  const auto [map_a, map_b] = scorer->depth_maps(facing.view);
  const std::vector<std::filesystem::path> files{folder / "depth_a.png", folder / "depth_b.png",
                                                 folder / "depth_difference.png"};
  draw_height_map(files[0], map_a, "A  " + name_a + ", seen from B");
  draw_height_map(files[1], zbuffer::mirrored(map_b), "B  " + name_b + ", seen from A, mirrored");
  draw_difference(files[2], map_a, map_b, view.view_side);
  return files;
}

mesh::Mesh tinted(const mesh::Mesh& surface, Colour tint) {
  mesh::Mesh result = surface;
  result.colours.assign(result.vertices.size(), tint);
  return result;
}

/// \return the two files
std::vector<std::filesystem::path> write_joined(const std::filesystem::path& folder, const match::Fragment& a,
                                                const match::Fragment& b, const Rigid& pose) {
  const mesh::Mesh first = tinted(a.surface, kTintA);
  const mesh::Mesh second = tinted(b.surface, kTintB);
  const std::vector<mesh::Placed> parts{{file_name(a.path), &first, Rigid{}},
                                        {file_name(b.path), &second, pose}};
  std::vector<std::filesystem::path> files{folder / "joined.glb", folder / "joined.ply"};
  for (const auto& file : files) mesh::save_scene(file, parts);
  return files;
}

}  // namespace

std::vector<std::filesystem::path> write_match_outputs(const std::filesystem::path& folder,
                                                       const match::Fragment& a, const match::Fragment& b,
                                                       const match::Result& result,
                                                       const MatchOutputOptions& options) {
  make_folder(folder);
  const std::string name_a = file_name(a.path);
  const std::string name_b = file_name(b.path);
  std::vector<std::filesystem::path> files{folder / "convergence.svg"};
  write_file(files[0], convergence_svg(result, name_a + " and " + name_b));
  if (result.candidates.empty()) return files;
  const match::Candidate& best = result.candidates.front();
  const Joint joint =
      make_joint(a.surface, b.surface, best.pose, view_direction(best), std::max(a.resolution, b.resolution));
  files.push_back(folder / "match.png");
  const std::string backend = std::string(zbuffer::name_of(result.backend)) + " (" + result.renderer + ")";
  write_png(files.back(), draw_match_sheet(joint, {name_a, name_b, result.verdict, best, backend}));
  for (const auto& file : write_depth_maps(folder, joint, name_a, name_b, options.map_resolution))
    files.push_back(file);
  for (const auto& file : write_joined(folder, a, b, best.pose)) files.push_back(file);
  return files;
}

}  // namespace rejoin::report
