#include "mesh/detail/specks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "mesh/detail/cloud_parts.hpp"
#include "mesh/detail/parts.hpp"
#include "mesh/detail/point_box.hpp"
#include "mesh/detail/weld.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr double kSmall = 0.01;     // of the whole area, or of all points
constexpr double kApart = 0.1;      // of the diagonal of the larger parts' box
constexpr double kDust = 5e-4;      // of the whole area: no patch of a piece
constexpr double kMostDust = 0.05;  // of the area; more is a surface in shreds
constexpr double kAfloat = 2.0;     // edges of a mean triangle

/// Which parts are specks.
std::vector<bool> specks_among(const std::vector<Part>& parts) {
  double all = 0;
  for (const Part& part : parts) all += part.weight;
  Part kept;
  std::vector<std::size_t> small;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k].weight >= kSmall * all) {
      kept.add(parts[k]);
    } else {
      small.push_back(k);
    }
  }
  std::vector<bool> result(parts.size(), false);
  if (!(kept.weight > 0)) return result;
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

/// Points of a face that is larger than they are apart, in rows along its longest side: of a sliver few.
void add_points_between(const Mesh& mesh, const glm::uvec3& face, float apart,
                        std::vector<glm::vec3>& points) {
  constexpr float kMostSteps = 256;
  std::array<glm::vec3, 3> p{mesh.vertices[face.x], mesh.vertices[face.y], mesh.vertices[face.z]};
  for (int turn = 0; turn < 2; ++turn) {
    const float first = glm::distance(p[0], p[1]);
    if (first >= glm::distance(p[1], p[2]) && first >= glm::distance(p[2], p[0])) break;
    std::rotate(p.begin(), p.begin() + 1, p.end());
  }
  const glm::vec3 along = p[1] - p[0];
  const float length = glm::length(along);
  if (length <= apart) return;
  const float height = glm::length(glm::cross(along, p[2] - p[0])) / length;
  const auto steps = [&](float extent) {
    return std::max(1, static_cast<int>(std::min(kMostSteps, std::ceil(extent / apart))));
  };
  const int rows = steps(height);
  for (int row = 0; row < rows; ++row) {
    const float up = static_cast<float>(row) / static_cast<float>(rows);
    const int count = steps((1.0F - up) * length);
    for (int k = 0; k <= count; ++k) {
      const float share = static_cast<float>(k) / static_cast<float>(count);
      points.push_back(p[0] + up * (p[2] - p[0]) + share * (1.0F - up) * along);
    }
  }
}

/// Points of the surface, at most that far apart: the vertices, and more of large faces.
/// \param without  per part: left out
std::vector<glm::vec3> points_on(const Mesh& mesh, const std::vector<std::uint32_t>& part_of_face,
                                 const std::vector<bool>& without, float apart) {
  std::vector<bool> used(mesh.vertices.size(), false);
  std::vector<glm::vec3> points;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (without[part_of_face[f]]) continue;
    const glm::uvec3& face = mesh.faces[f];
    for (int corner = 0; corner < 3; ++corner) used[face[corner]] = true;
    add_points_between(mesh, face, apart, points);
  }
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) points.push_back(mesh.vertices[v]);
  return points;
}

/// Parts that are too small for a patch of the piece and float beside the surface of all larger ones.
std::vector<bool> dust_among(const Mesh& mesh, const std::vector<std::uint32_t>& part_of_face,
                             const std::vector<Part>& parts) {
  double all = 0;
  for (const Part& part : parts) all += part.weight;
  std::vector<bool> result(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) result[k] = parts[k].weight < kDust * all;
  double area = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) area += result[k] ? 0.0 : parts[k].weight;
  if (area < (1.0 - kMostDust) * all) return std::vector<bool>(parts.size(), false);
  if (std::ranges::count(result, true) == 0) return result;
  const auto faces = static_cast<double>(
      std::ranges::count_if(part_of_face, [&](std::uint32_t part) { return !result[part]; }));
  const auto afloat = static_cast<float>(kAfloat * std::sqrt(4.0 / std::sqrt(3.0) * area / faces));
  const PointIndex index(points_on(mesh, part_of_face, result, afloat));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (int corner = 0; corner < 3 && result[part_of_face[f]]; ++corner) {
      if (index.nearest_within(mesh.vertices[mesh.faces[f][corner]], afloat)) result[part_of_face[f]] = false;
    }
  }
  return result;
}

void drop_points(Mesh& cloud, const std::vector<bool>& dropped) {
  const auto keep = [&](auto& values) {
    if (values.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < dropped.size(); ++i) {
      if (!dropped[i]) values[kept++] = values[i];
    }
    values.resize(kept);
  };
  keep(cloud.vertices);
  keep(cloud.normals);
  keep(cloud.colours);
}

}  // namespace

Specks drop_specks(Mesh& mesh) {
  const std::vector<std::uint32_t> part_of_face = part_of_faces(mesh);
  std::vector<Part> parts = measured_parts(mesh, part_of_face);
  std::vector<bool> dropped = dust_among(mesh, part_of_face, parts);
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (dropped[k]) parts[k] = {};
  const std::vector<bool> far = specks_among(parts);
  for (std::size_t k = 0; k < parts.size(); ++k) dropped[k] = dropped[k] || far[k];
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

Spikes drop_spikes(Mesh& mesh) {
  constexpr std::size_t kOneIn = 1000;
  constexpr std::size_t kOneFaceIn = 100;
  constexpr std::size_t kSampled = 10000;
  const std::vector<glm::vec3>& vertices = mesh.vertices;
  if (vertices.size() < kOneIn) return {};
  std::vector<glm::dvec3> sample;
  for (std::size_t v = 0; v < vertices.size(); v += 1 + vertices.size() / kSampled)
    sample.emplace_back(vertices[v]);
  const PointBox most = box_of_most(sample);
  const auto is_far = [&](std::uint32_t v) {
    const glm::dvec3 p(vertices[v]);
    return glm::distance(p, glm::clamp(p, most.low, most.high)) > kFar * most.size();
  };
  Spikes spikes;
  for (std::uint32_t v = 0; v < vertices.size(); ++v) spikes.vertices += is_far(v) ? 1 : 0;
  if (spikes.vertices == 0 || kOneIn * spikes.vertices > vertices.size()) return {};
  const auto of_spike = [&](const glm::uvec3& face) {
    return is_far(face.x) || is_far(face.y) || is_far(face.z);
  };
  const auto faces = static_cast<std::size_t>(std::ranges::count_if(mesh.faces, of_spike));
  if (kOneFaceIn * faces > mesh.faces.size()) return {};  // the tip of a fan is no mistake
  spikes.faces = std::erase_if(mesh.faces, of_spike);
  drop_unused_vertices(mesh);
  return spikes;
}

std::size_t drop_stray_points(Mesh& cloud, const NeighbourLists& near) {
  const std::size_t count = cloud.vertices.size();
  if (count <= 4 * kNeighbours) return 0;
  const CloudParts found = parts_of_cloud(cloud.vertices, near);
  std::vector<Part> parts(found.count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 point(cloud.vertices[i]);
    if (!found.stray[i]) parts[found.part_of_point[i]].add({point, point, 1.0, {}});
  }
  std::vector<bool> dropped = found.stray;
  const std::vector<bool> specks = specks_among(parts);
  for (std::uint32_t i = 0; i < count; ++i) dropped[i] = dropped[i] || specks[found.part_of_point[i]];
  const auto strays = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), true));
  if (strays > 0) drop_points(cloud, dropped);
  return strays;
}

}  // namespace rejoin::mesh::detail
