#include "zbuffer/detail/outward.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace rejoin::zbuffer::detail {
namespace {

/// Sets of vertices.
class Components {
 public:
  explicit Components(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t of(std::uint32_t vertex) {
    while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
    return vertex;
  }
  void unite(std::uint32_t a, std::uint32_t b) { parent_[of(a)] = of(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// The edges of all faces by their lower vertex: the other one, and whether the face goes up along it.
class Edges {
 public:
  struct End {
    std::uint32_t upper;
    bool up;
  };

  Edges(std::size_t vertices, std::span<const glm::uvec3> faces)
      : start_(vertices + 1), ends_(3 * faces.size()) {
    for_each(faces, [&](std::uint32_t lower, End) { ++start_[lower + 1]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for_each(faces, [&](std::uint32_t lower, End end) { ends_[next[lower]++] = end; });
  }

  /// Whether each edge above this vertex belongs to one face that goes up along it and to one that goes down.
  bool are_closed(std::uint32_t lower) const {
    const std::span<const End> here(ends_.data() + start_[lower], start_[lower + 1] - start_[lower]);
    for (const End& end : here) {
      int up = 0;
      int down = 0;
      for (const End& other : here) {
        if (other.upper == end.upper) ++(other.up ? up : down);
      }
      if (up != 1 || down != 1) return false;
    }
    return true;
  }

 private:
  template <class Use>
  static void for_each(std::span<const glm::uvec3> faces, const Use& use) {
    for (const glm::uvec3& face : faces) {
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t from = face[k];
        const std::uint32_t to = face[(k + 1) % 3];
        use(std::min(from, to), {std::max(from, to), from < to});
      }
    }
  }

  std::vector<std::size_t> start_;
  std::vector<End> ends_;
};

}  // namespace

std::vector<bool> seen_from_front(const mesh::Mesh& mesh, std::span<const glm::uvec3> faces) {
  const std::size_t count = mesh.vertices.size();
  Components components(count);
  for (const glm::uvec3& face : faces) {
    components.unite(face.x, face.y);
    components.unite(face.y, face.z);
  }
  const Edges edges(count, faces);
  std::vector<bool> open(count, false);  // of the vertex that stands for a component
  for (std::uint32_t v = 0; v < count; ++v) {
    if (!edges.are_closed(v)) open[components.of(v)] = true;
  }
  std::vector<double> volume(count, 0.0);
  for (const glm::uvec3& face : faces) {
    const std::uint32_t component = components.of(face.x);
    if (open[component]) continue;
    const glm::dvec3 a(mesh.vertices[face.x]);
    const glm::dvec3 b(mesh.vertices[face.y]);
    volume[component] += glm::dot(a, glm::cross(b, glm::dvec3(mesh.vertices[face.z])));
  }
  std::vector<bool> result;
  result.reserve(faces.size());
  for (const glm::uvec3& face : faces) {
    const std::uint32_t component = components.of(face.x);
    result.push_back(!open[component] && volume[component] > 0.0);
  }
  return result;
}

}  // namespace rejoin::zbuffer::detail
