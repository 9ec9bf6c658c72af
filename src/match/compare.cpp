#include "match/compare.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "match/gap.hpp"
#include "match/judge.hpp"
#include "match/verify.hpp"

namespace rejoin::match {
namespace {

using zbuffer::DepthMap;
using zbuffer::PairScore;
using zbuffer::ViewPair;
using Maps = std::pair<DepthMap, DepthMap>;

constexpr double kContactReach = 0.02;  // of the diameter

glm::dvec3 joint_direction(const Fragment& a, const Fragment& b, const Rigid& pose) {
  const double reach = kContactReach * std::max(a.diameter, b.diameter);
  const Contact contact = contact_of(a.surface, gaps(a.surface, GapField(b.surface), pose, reach));
  if (glm::length(contact.normal) > 0) return contact.normal;
  const glm::dvec3 between =
      pose(b.surface.origin + mesh::centroid(b.surface)) - (a.surface.origin + mesh::centroid(a.surface));
  const double length = glm::length(between);
  return length > 0 ? between / length : glm::dvec3(0, 0, 1);
}

zbuffer::ViewOptions view_options(const mesh::Mesh& a, const mesh::Mesh& b, const PoseView& view,
                                  int resolution) {
  zbuffer::ViewOptions options;
  options.resolution = resolution;
  options.view_side = view.view_side;
  options.centre_a = glm::vec3(view.centres.a - a.origin);
  options.centre_b = glm::vec3(view.centres.b - b.origin);
  return options;
}

/// The view of a grid pose: A is turned and shifted a little more.
ViewPair moved(const ViewPair& view, const GridPose& pose) {
  const glm::dmat3 turn = axis_rotation({0, 0, 1}, glm::radians(pose.angles_deg[2])) *
                          axis_rotation({1, 0, 0}, glm::radians(pose.angles_deg[0])) *
                          axis_rotation({0, 1, 0}, glm::radians(pose.angles_deg[1]));
  ViewPair result = view;
  result.rotation_a = glm::mat3(turn * glm::dmat3(view.rotation_a));
  result.shift_a += glm::vec2(pose.shift[0], pose.shift[1]);
  return result;
}

std::vector<GridPose> make_grid(const CompareOptions& options, double shift_step) {
  const int side = 2 * options.steps + 1;
  const int count = side * side * side * side * side;
  std::vector<GridPose> grid(count);
  for (int k = 0; k < count; ++k) {
    int rest = k;
    const auto next = [&] {
      const int step = rest % side - options.steps;
      rest /= side;
      return step;
    };
    for (double& angle : grid[k].angles_deg) angle = next() * options.angle_step_deg;
    for (double& shift : grid[k].shift) shift = next() * shift_step;
  }
  return grid;
}

void check(const CompareOptions& options) {
  if (options.steps < 0 || options.steps > 4) {
    throw InputError("grid steps", std::to_string(options.steps) + " is out of range", "choose 0 .. 4");
  }
  if (!(options.angle_step_deg >= 0 && options.angle_step_deg <= 45) ||
      !(options.shift_step >= 0 && options.shift_step <= 0.5)) {
    throw InputError("grid", "a step is out of range",
                     "choose angles of 0 .. 45 degrees and shifts of 0 .. 0.5 diameters");
  }
}

ErrorAgreement agreement(const std::vector<GridPose>& grid, PairScore GridPose::*first,
                         PairScore GridPose::*second, int resolution) {
  ErrorAgreement result;
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0, sum_yy = 0;
  for (const GridPose& pose : grid) {
    const double x = static_cast<double>((pose.*first).error) * resolution;
    const double y = static_cast<double>((pose.*second).error) * resolution;
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    ++result.poses;
    result.mean += std::abs(x - y);
    result.max = std::max(result.max, std::abs(x - y));
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
    sum_yy += y * y;
  }
  if (result.poses == 0) return result;
  const double n = result.poses;
  result.mean /= n;
  result.relative = sum_y > 0 ? result.mean * n / sum_y : 0;
  const double spread = (sum_xx - sum_x * sum_x / n) * (sum_yy - sum_y * sum_y / n);
  result.correlation = spread > 0 ? (sum_xy - sum_x * sum_y / n) / std::sqrt(spread) : 0;
  return result;
}

std::string label(const zbuffer::Scorer& scorer, const mesh::Mesh& a, const mesh::Mesh& b) {
  return std::string(zbuffer::name_of(scorer.backend())) + ", " + std::to_string(a.faces.size()) + " and " +
         std::to_string(b.faces.size()) + " faces";
}

}  // namespace

PoseView view_of_pose(const Fragment& a, const Fragment& b, const Rigid& pose) {
  constexpr double kViewToDiameter = 1.3;  // f_R, papaioannou 2002, section 3.4
  PoseView view;
  view.centres = {a.surface.origin + view_centre(a.surface), b.surface.origin + view_centre(b.surface)};
  view.facing = facing_view(pose, joint_direction(a, b, pose), view.centres);
  view.view_side = kViewToDiameter * std::max(a.diameter, b.diameter);
  return view;
}

Comparison compare(const Fragment& a, const Fragment& b, const Rigid& pose, const CompareOptions& options,
                   const Context& context) {
  check(options);
  Comparison result;
  result.resolution = options.resolution;
  const Judged judged = judge(a, b, pose);
  result.joint = unmeasured(a, b, to_origins(a, b, pose), judged.evidence, strength(judged.evidence));
  result.view = view_of_pose(a, b, pose);
  const auto make = [&](zbuffer::Backend backend, const mesh::Mesh& first, const mesh::Mesh& second) {
    return zbuffer::make_scorer(backend, first, second,
                                view_options(first, second, result.view, options.resolution));
  };
  const auto drawn = make(options.drawing, a.coarse, b.coarse);
  const auto cast = make(zbuffer::Backend::RayCast, a.coarse, b.coarse);
  const auto full = make(zbuffer::Backend::RayCast, a.surface, b.surface);
  result.renderer = drawn->renderer();
  result.caster = full->renderer();
  const ViewPair& view = result.view.facing.view;
  const Maps cast_maps = cast->depth_maps(view);
  result.drawing = rendering_difference(drawn->depth_maps(view), cast_maps, result.view.view_side);
  result.detail = rendering_difference(cast_maps, full->depth_maps(view), result.view.view_side);
  result.drawing.first = label(*drawn, a.coarse, b.coarse);
  result.drawing.second = result.detail.first = label(*cast, a.coarse, b.coarse);
  result.detail.second = label(*full, a.surface, b.surface);

  result.grid = make_grid(options, options.shift_step * std::max(a.diameter, b.diameter));
  std::vector<ViewPair> views;
  for (const GridPose& grid_pose : result.grid) views.push_back(moved(view, grid_pose));
  const std::array<std::pair<zbuffer::Scorer*, PairScore GridPose::*>, 3> columns{
      {{drawn.get(), &GridPose::drawn}, {cast.get(), &GridPose::cast}, {full.get(), &GridPose::cast_full}}};
  std::vector<PairScore> scores(views.size());
  for (std::size_t k = 0; k < columns.size(); ++k) {
    context.report("compare", static_cast<double>(k) / columns.size());
    if (context.cancelled()) return result;
    columns[k].first->score(views, scores);
    for (std::size_t i = 0; i < views.size(); ++i) result.grid[i].*columns[k].second = scores[i];
  }
  result.pose = result.grid[result.grid.size() / 2];
  result.drawing_agreement = agreement(result.grid, &GridPose::drawn, &GridPose::cast, options.resolution);
  result.detail_agreement = agreement(result.grid, &GridPose::cast, &GridPose::cast_full, options.resolution);
  result.total_agreement = agreement(result.grid, &GridPose::drawn, &GridPose::cast_full, options.resolution);
  return result;
}

}  // namespace rejoin::match
