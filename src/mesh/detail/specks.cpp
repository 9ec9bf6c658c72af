#include "mesh/detail/specks.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/components.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr double kSmall = 0.01;  // of the whole area
constexpr double kApart = 0.1;   // of the diagonal of the larger parts' box

/// Box and area of a part; of nothing at first.
struct Part {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
  double area = 0;

  void add(const Part& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
    area += other.area;
  }
  double distance(const Part& other) const {
    return glm::length(glm::max(glm::dvec3(0.0), glm::max(other.low - high, low - other.high)));
  }
};

/// Number of the part of every face, from 0 in the order of their first faces.
std::vector<std::uint32_t> part_of_faces(const Mesh& mesh) {
  Components components(mesh.vertices.size());
  for (const glm::uvec3& face : mesh.faces) {
    components.unite(face.x, face.y);
    components.unite(face.x, face.z);
  }
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNone);
  std::vector<std::uint32_t> result;
  result.reserve(mesh.faces.size());
  std::uint32_t count = 0;
  for (const glm::uvec3& face : mesh.faces) {
    std::uint32_t& part = number[components.of(face.x)];
    if (part == kNone) part = count++;
    result.push_back(part);
  }
  return result;
}

std::vector<Part> measured(const Mesh& mesh, const std::vector<std::uint32_t>& part_of_face) {
  std::vector<Part> parts(*std::max_element(part_of_face.begin(), part_of_face.end()) + 1);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const glm::uvec3& face = mesh.faces[f];
    const glm::dvec3 a(mesh.vertices[face.x]);
    const glm::dvec3 b(mesh.vertices[face.y]);
    const glm::dvec3 c(mesh.vertices[face.z]);
    parts[part_of_face[f]].add({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)),
                                0.5 * glm::length(glm::cross(b - a, c - a))});
  }
  return parts;
}

/// Which parts are specks.
std::vector<bool> specks_among(const std::vector<Part>& parts) {
  double area = 0;
  for (const Part& part : parts) area += part.area;
  Part kept;
  std::vector<std::size_t> small;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k].area >= kSmall * area) {
      kept.add(parts[k]);
    } else {
      small.push_back(k);
    }
  }
  std::vector<bool> result(parts.size(), false);
  if (!(kept.area > 0)) return result;
  const double apart = kApart * glm::distance(kept.low, kept.high);
  // From near to far: what lies near a patch that is kept is kept, too.
  std::vector<std::pair<double, std::size_t>> order;
  order.reserve(small.size());
  for (const std::size_t k : small) order.emplace_back(kept.distance(parts[k]), k);
  std::sort(order.begin(), order.end());
  for (const auto& [distance, k] : order) {
    result[k] = kept.distance(parts[k]) > apart;
    if (!result[k]) kept.add(parts[k]);
  }
  return result;
}

}  // namespace

Specks drop_specks(Mesh& mesh) {
  const std::vector<std::uint32_t> part_of_face = part_of_faces(mesh);
  const std::vector<Part> parts = measured(mesh, part_of_face);
  const std::vector<bool> dropped = specks_among(parts);
  Specks specks;
  specks.parts = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), true));
  if (specks.parts == 0) return specks;
  std::size_t kept = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!dropped[part_of_face[f]]) mesh.faces[kept++] = mesh.faces[f];
  }
  specks.faces = mesh.faces.size() - kept;
  mesh.faces.resize(kept);
  return specks;
}

}  // namespace rejoin::mesh::detail
