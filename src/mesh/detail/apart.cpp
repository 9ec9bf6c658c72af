#include "mesh/detail/apart.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "mesh/detail/directions.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr double kRoom = 0.02;    // between bodies, of the diagonal of the smaller one's box
constexpr double kBack = 0.3;     // of a part's area, by which it faces away from the other
constexpr double kClosed = 0.02;  // of a part's area, at most, is left when it is looked at from anywhere
constexpr std::size_t kDirections = 300;

struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

Span span_along(const Block& block, const glm::vec3& up) {
  Span span;
  for (const glm::vec3& vertex : block.mesh.vertices) {
    const double height = glm::dot(vertex, up);
    span.low = std::min(span.low, height);
    span.high = std::max(span.high, height);
  }
  return span;
}

double size_of(const Block& block) {
  return glm::distance(block.part.low, block.part.high);
}

/// Whether b lies above a with room between them, and the two are not the sides of one sherd.
bool lies_above(const Block& a, const Block& b, double room, const glm::dvec3& up) {
  return room > kRoom * std::min(size_of(a), size_of(b)) &&
         (glm::dot(a.part.facing, up) > -kBack * a.part.weight ||
          glm::dot(b.part.facing, up) < kBack * b.part.weight);
}

/// How often the surface winds around a point: 1 in a closed one that faces outwards, 0 outside (van Oosterom and Strackee 1983).
double winding(const Mesh& mesh, const glm::dvec3& point) {
  double sum = 0;
  for (const glm::uvec3& face : mesh.faces) {
    const glm::dvec3 a = glm::dvec3(mesh.vertices[face.x]) - point;
    const glm::dvec3 b = glm::dvec3(mesh.vertices[face.y]) - point;
    const glm::dvec3 c = glm::dvec3(mesh.vertices[face.z]) - point;
    const double la = glm::length(a);
    const double lb = glm::length(b);
    const double lc = glm::length(c);
    sum += std::atan2(glm::dot(a, glm::cross(b, c)),
                      la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / (2.0 * std::numbers::pi);
}

bool is_closed(const Block& block) {
  return !block.mesh.is_cloud() && glm::length(block.part.facing) < kClosed * block.part.weight;
}

bool lies_in(const Block& inner, const Block& outer) {
  const bool boxes = glm::all(glm::greaterThanEqual(inner.part.low, outer.part.low)) &&
                     glm::all(glm::lessThanEqual(inner.part.high, outer.part.high));
  return boxes && std::abs(winding(outer.mesh, glm::dvec3(inner.mesh.vertices.front()))) > 0.5;
}

}  // namespace

Apart apart_by_planes(const std::vector<Block>& blocks) {
  Apart apart(blocks.size(), std::vector<bool>(blocks.size(), false));
  std::vector<Span> spans(blocks.size());
  for (const glm::vec3& up : half_sphere_directions(kDirections)) {
    for (std::size_t k = 0; k < blocks.size(); ++k) spans[k] = span_along(blocks[k], up);
    for (std::size_t a = 0; a < blocks.size(); ++a) {
      for (std::size_t b = 0; b < blocks.size(); ++b) {
        if (lies_above(blocks[a], blocks[b], spans[b].low - spans[a].high, glm::dvec3(up)))
          apart[a][b] = apart[b][a] = true;
      }
    }
  }
  return apart;
}

bool are_two_closed(const Block& a, const Block& b) {
  return is_closed(a) && is_closed(b) && !lies_in(a, b) && !lies_in(b, a);
}

}  // namespace rejoin::mesh::detail
