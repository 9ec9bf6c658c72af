#include "zbuffer/detail/outward.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>

#include "core/components.hpp"
#include "zbuffer/detail/drawable.hpp"

namespace rejoin::zbuffer::detail {
namespace {

/// A face's edge at its lower vertex: the other one, and whether the face goes up along it.
struct End {
  std::uint32_t upper;
  bool up;
};

/// Calls use(lower vertex, end) for each edge of each face.
template <class Use>
void for_each_edge(const std::vector<glm::uvec3>& faces, const Use& use) {
  for (const glm::uvec3& face : faces) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = face[k];
      const std::uint32_t to = face[(k + 1) % 3];
      use(std::min(from, to), End{std::max(from, to), from < to});
    }
  }
}

/// Whether each edge belongs to one face that goes up along it and to one that goes down.
bool are_closed(std::span<End> ends) {
  std::ranges::sort(ends, {}, &End::upper);
  if (ends.size() % 2 != 0) return false;
  for (std::size_t k = 0; k < ends.size(); k += 2) {
    if (ends[k].upper != ends[k + 1].upper || ends[k].up == ends[k + 1].up) return false;
    if (k > 0 && ends[k].upper == ends[k - 1].upper) return false;
  }
  return true;
}

/// The vertices whose edges to higher ones are not closed.
std::vector<std::uint32_t> open_vertices(std::size_t count, const std::vector<glm::uvec3>& faces) {
  std::vector<std::size_t> start(count + 1);
  for_each_edge(faces, [&](std::uint32_t lower, const End&) { ++start[lower + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<End> ends(3 * faces.size());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for_each_edge(faces, [&](std::uint32_t lower, const End& end) { ends[next[lower]++] = end; });
  std::vector<std::uint32_t> open;
  for (std::uint32_t v = 0; v < count; ++v) {
    if (!are_closed(std::span(ends).subspan(start[v], start[v + 1] - start[v]))) open.push_back(v);
  }
  return open;
}

}  // namespace

SidedFaces sided_faces(const mesh::Mesh& mesh) {
  const std::vector<glm::uvec3> faces = finite_faces(mesh);
  Components components(mesh.vertices.size());
  for (const glm::uvec3& face : faces) {
    components.unite(face.x, face.y);
    components.unite(face.y, face.z);
  }
  std::vector<double> volume(mesh.vertices.size(),
                             0.0);  // six times that of the component a vertex stands for
  for (const glm::uvec3& face : faces) {
    const glm::dvec3 a(mesh.vertices[face.x]);
    const glm::dvec3 b(mesh.vertices[face.y]);
    volume[components.of(face.x)] += glm::dot(a, glm::cross(b, glm::dvec3(mesh.vertices[face.z])));
  }
  for (const std::uint32_t vertex : open_vertices(mesh.vertices.size(), faces))
    volume[components.of(vertex)] = 0.0;
  SidedFaces result;
  for (const glm::uvec3& face : faces) {
    (volume[components.of(face.x)] > 0.0 ? result.front_only : result.both).push_back(face);
  }
  return result;
}

}  // namespace rejoin::zbuffer::detail
