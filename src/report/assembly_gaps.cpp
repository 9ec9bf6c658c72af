#include "report/assembly_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/median.hpp"
#include "match/gap.hpp"
#include "report/canvas.hpp"
#include "report/colour_scale.hpp"

namespace rejoin::report {
namespace {

/// A ball that holds a surface, common frame.
struct Ball {
  glm::dvec3 centre;
  double radius;
};

Ball ball_of(const PlacedSurface& surface) {
  const mesh::Box box = mesh::bounds(*surface.mesh);
  const glm::dvec3 low(box.low);
  const glm::dvec3 high(box.high);
  return {surface.pose(surface.mesh->origin + (low + high) / 2.0), glm::distance(low, high) / 2};
}

/// Keeps of each vertex the gap of least size among those in contact.
void keep_nearest(std::vector<float>& kept, const match::Gaps& gaps) {
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (!match::in_contact(gaps, k)) continue;
    if (std::isnan(kept[k]) || std::abs(gaps.gap[k]) < std::abs(kept[k])) kept[k] = gaps.gap[k];
  }
}

}  // namespace

std::vector<std::vector<float>> assembly_gaps(const std::vector<PlacedSurface>& surfaces, double reach,
                                              const Context& context) {
  std::vector<Ball> balls;
  balls.reserve(surfaces.size());
  std::vector<std::vector<float>> result;
  result.reserve(surfaces.size());
  for (const PlacedSurface& surface : surfaces) {
    balls.push_back(ball_of(surface));
    result.emplace_back(surface.mesh->vertices.size(), std::numeric_limits<float>::quiet_NaN());
  }
  for (std::size_t j = 0; j < surfaces.size(); ++j) {
    if (context.cancelled()) return {};
    context.report("gaps", static_cast<double>(j) / static_cast<double>(surfaces.size()));
    const match::GapField field(*surfaces[j].mesh);
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      const bool apart =
          glm::distance(balls[i].centre, balls[j].centre) > balls[i].radius + balls[j].radius + reach;
      if (i == j || surfaces[i].group != surfaces[j].group || apart) continue;
      keep_nearest(result[i], match::gaps(*surfaces[i].mesh, field,
                                          inverse(surfaces[i].pose) * surfaces[j].pose, reach));
    }
  }
  return result;
}

double gap_scale(const std::vector<std::vector<float>>& gaps, double reach) {
  constexpr double kFinest = 1e-3;  // of the reach: below that it is rounding, not shape
  std::vector<float> sizes;
  for (const std::vector<float>& of_surface : gaps) {
    for (const float gap : of_surface)
      if (!std::isnan(gap)) sizes.push_back(std::abs(gap));
  }
  if (sizes.empty()) return reach / 2;
  const double typical = kMedianGaps * static_cast<double>(median(sizes));
  return std::min(reach / 2, round_up(std::max(typical, kFinest * reach)));
}

}  // namespace rejoin::report
