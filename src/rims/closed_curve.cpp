#include "rims/closed_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace rejoin::rims {
namespace {

/// A mesh edge by its vertices, the smaller first.
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Where the function is 0 on an edge.
glm::dvec3 crossing(const mesh::Mesh& mesh, std::span<const float> values, const Edge& edge) {
  const auto low = static_cast<double>(values[edge.first]);
  const auto high = static_cast<double>(values[edge.second]);
  return glm::mix(glm::dvec3(mesh.vertices[edge.first]), glm::dvec3(mesh.vertices[edge.second]),
                  low / (low - high));
}

}  // namespace

double length_of(const ClosedCurve& curve) {
  double sum = 0.0;
  for (std::size_t i = 0; i < curve.size(); ++i)
    sum += glm::distance(curve[i], curve[(i + 1) % curve.size()]);
  return sum;
}

ClosedCurve resampled(const ClosedCurve& curve, std::size_t count) {
  const double step = length_of(curve) / static_cast<double>(count);
  ClosedCurve result;
  result.reserve(count);
  double passed = 0.0;
  for (std::size_t i = 0; i < curve.size() && result.size() < count; ++i) {
    const glm::dvec3& next = curve[(i + 1) % curve.size()];
    const double edge = glm::distance(curve[i], next);
    while (result.size() < count && static_cast<double>(result.size()) * step < passed + edge) {
      const double share = (static_cast<double>(result.size()) * step - passed) / edge;
      result.push_back(glm::mix(curve[i], next, share));
    }
    passed += edge;
  }
  while (result.size() < count) result.push_back(curve.front());
  return result;
}

std::vector<ClosedCurve> zero_curves(const mesh::Mesh& mesh, std::span<const float> values) {
  // The segment of a face runs from the edge where the function falls to the one where it rises, going around the face:
  // so positive corners are on its left.  The next segment starts on the edge on which this one ends.
  std::map<Edge, Edge> next;
  const auto positive = [&](std::uint32_t v) { return values[v] > 0.0F; };
  for (const glm::uvec3& face : mesh.faces) {
    Edge from;
    Edge to;
    int crossed = 0;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = face[k];
      const std::uint32_t b = face[(k + 1) % 3];
      if (positive(a) == positive(b)) continue;
      (positive(b) ? to : from) = std::minmax(a, b);
      ++crossed;
    }
    if (crossed == 2) next[from] = to;
  }
  std::vector<ClosedCurve> curves;
  while (!next.empty()) {
    const Edge first = next.begin()->first;
    ClosedCurve curve;
    Edge at = first;
    for (auto step = next.find(at); step != next.end(); step = next.find(at)) {
      curve.push_back(crossing(mesh, values, at));
      at = step->second;
      next.erase(step);
    }
    if (at == first && curve.size() >= 3) curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace rejoin::rims
