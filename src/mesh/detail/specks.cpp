#include "mesh/detail/specks.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/components.hpp"
#include "core/median.hpp"
#include "core/parallel.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr double kSmall = 0.01;  // of the whole area, or of all points
constexpr double kApart = 0.1;   // of the diagonal of the larger parts' box
constexpr double kTable = 0.3;   // of the whole area, at least
constexpr double kFlat = 0.995;  // of a part's area that is left of it when looked at from the front
constexpr float kSparse = 2.5F;  // times the reach that is usual among its neighbours

/// Box and weight of a part; of nothing at first.
struct Part {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
  double weight = 0;       ///< area, or number of points
  glm::dvec3 facing{0.0};  ///< its faces' area vectors

  void add(const Part& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
    weight += other.weight;
    facing += other.facing;
  }
  double distance(const Part& other) const {
    return glm::length(glm::max(glm::dvec3(0.0), glm::max(other.low - high, low - other.high)));
  }
};

/// Numbers parts from 0 in the order in which their elements are asked for.
class PartNumbers {
 public:
  PartNumbers(Components& components, std::size_t elements)
      : components_(components), number_(elements, kNone) {}

  std::uint32_t of(std::uint32_t element) {
    std::uint32_t& part = number_[components_.of(element)];
    if (part == kNone) part = count_++;
    return part;
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  Components& components_;
  std::vector<std::uint32_t> number_;
  std::uint32_t count_ = 0;
};

std::vector<std::uint32_t> part_of_faces(const Mesh& mesh) {
  Components components(mesh.vertices.size());
  for (const glm::uvec3& face : mesh.faces) {
    components.unite(face.x, face.y);
    components.unite(face.x, face.z);
  }
  PartNumbers numbers(components, mesh.vertices.size());
  std::vector<std::uint32_t> result;
  result.reserve(mesh.faces.size());
  for (const glm::uvec3& face : mesh.faces) result.push_back(numbers.of(face.x));
  return result;
}

std::vector<Part> measured(const Mesh& mesh, const std::vector<std::uint32_t>& part_of_face) {
  std::vector<Part> parts(*std::max_element(part_of_face.begin(), part_of_face.end()) + 1);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const glm::uvec3& face = mesh.faces[f];
    const glm::dvec3 a(mesh.vertices[face.x]);
    const glm::dvec3 b(mesh.vertices[face.y]);
    const glm::dvec3 c(mesh.vertices[face.z]);
    const glm::dvec3 facing = 0.5 * glm::cross(b - a, c - a);
    parts[part_of_face[f]].add(
        {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)), glm::length(facing), facing});
  }
  return parts;
}

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

/// Whether a part is a plane that takes up much of the whole, beside others.
bool is_table(const Part& part, double all) {
  return part.weight > kTable * all && part.weight < (1.0 - kSmall) * all &&
         glm::length(part.facing) > kFlat * part.weight;
}

/// Distance of every point from the furthest of its neighbours.
std::vector<float> reaches(const std::vector<glm::vec3>& points, const NeighbourLists& near) {
  std::vector<float> result(points.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = glm::distance(points[i], points[near[i].back()]);
  return result;
}

/// What is usual among every point's neighbours.
std::vector<float> usual_reach(const std::vector<float>& reach, const NeighbourLists& near) {
  std::vector<float> usual(reach.size());
  parallel_for(usual.size(), 512, [&](std::size_t first, std::size_t last) {
    std::vector<float> around;
    for (std::size_t i = first; i < last; ++i) {
      around.clear();
      for (const std::uint32_t k : near[i]) {
        if (k != i) around.push_back(reach[k]);
      }
      usual[i] = median(around);
    }
  });
  return usual;
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
  const std::vector<Part> parts = measured(mesh, part_of_face);
  const std::vector<bool> dropped = specks_among(parts);
  Specks specks;
  double all = 0;
  for (const Part& part : parts) all += part.weight;
  specks.table =
      std::any_of(parts.begin(), parts.end(), [&](const Part& part) { return is_table(part, all); });
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

std::size_t drop_stray_points(Mesh& cloud, const NeighbourLists& near) {
  const std::size_t count = cloud.vertices.size();
  if (count <= 4 * kNeighbours) return 0;
  const std::vector<float> reach = reaches(cloud.vertices, near);
  const std::vector<float> usual = usual_reach(reach, near);
  std::vector<bool> dropped(count);
  for (std::size_t i = 0; i < count; ++i) dropped[i] = reach[i] > kSparse * usual[i];

  Components components(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (const std::uint32_t k : near[i]) {
      const float step = glm::distance(cloud.vertices[i], cloud.vertices[k]);
      if (!dropped[i] && !dropped[k] && step <= kSparse * usual[i]) components.unite(i, k);
    }
  }
  PartNumbers numbers(components, count);
  std::vector<Part> parts;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t part = numbers.of(i);
    if (part == parts.size()) parts.emplace_back();
    const glm::dvec3 point(cloud.vertices[i]);
    if (!dropped[i]) parts[part].add({point, point, 1.0, {}});
  }
  const std::vector<bool> specks = specks_among(parts);
  for (std::uint32_t i = 0; i < count; ++i) dropped[i] = dropped[i] || specks[numbers.of(i)];
  const auto strays = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), true));
  if (strays > 0) drop_points(cloud, dropped);
  return strays;
}

}  // namespace rejoin::mesh::detail
