#include "mesh/detail/orient.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "core/components.hpp"
#include "mesh/detail/outlook.hpp"

namespace rejoin::mesh::detail {
namespace {

/// One side of a face, by the edge's smaller and larger vertex.
struct Side {
  std::uint64_t edge;
  std::uint32_t face;
  bool forward;  ///< runs from the smaller to the larger vertex
};

/// Sides by edge, then by face.  Dealt out by the smaller vertex first, of which each has a few: millions take half the time then.
std::vector<Side> sorted_sides(const Mesh& mesh) {
  std::vector<std::uint32_t> first(mesh.vertices.size() + 1, 0);
  const auto for_each_side = [&mesh](const auto& visit) {
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      const glm::uvec3 face = mesh.faces[f];
      for (int k = 0; k < 3; ++k) visit(face[k], face[(k + 1) % 3], f);
    }
  };
  for_each_side([&first](std::uint32_t a, std::uint32_t b, std::uint32_t) { ++first[std::min(a, b) + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Side> sides(3 * mesh.faces.size());
  for_each_side([&](std::uint32_t a, std::uint32_t b, std::uint32_t f) {
    const std::uint64_t low = std::min(a, b);
    sides[first[low]++] = {(low << 32U) | std::max(a, b), f, a < b};
  });
  std::size_t begin = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {  // of each vertex first has become the end
    std::sort(
        sides.begin() + static_cast<std::ptrdiff_t>(begin), sides.begin() + first[v],
        [](const Side& a, const Side& b) { return a.edge != b.edge ? a.edge < b.edge : a.face < b.face; });
    begin = first[v];
  }
  return sides;
}

struct Neighbour {
  std::uint32_t face;
  bool agrees;
};

struct Adjacency {
  std::vector<std::uint32_t> first;  ///< per face, into neighbours
  std::vector<Neighbour> neighbours;
  bool closed = true;  ///< every edge has an even number of faces
  bool consistent = true;
};

/// Faces joined across edges of exactly two faces.
Adjacency adjacency_of(const Mesh& mesh) {
  const std::vector<Side> sides = sorted_sides(mesh);
  Adjacency adjacency;
  std::vector<std::pair<std::uint32_t, Neighbour>> links;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
    if ((end - i) % 2 == 1) adjacency.closed = false;
    if (end - i == 2) {
      const bool agrees = sides[i].forward != sides[i + 1].forward;
      adjacency.consistent = adjacency.consistent && agrees;
      links.emplace_back(sides[i].face, Neighbour{sides[i + 1].face, agrees});
      links.emplace_back(sides[i + 1].face, Neighbour{sides[i].face, agrees});
    }
    i = end;
  }
  if (adjacency.consistent) return adjacency;
  std::stable_sort(links.begin(), links.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  adjacency.first.assign(mesh.faces.size() + 1, 0);
  for (const auto& [face, neighbour] : links) {
    ++adjacency.first[face + 1];
    adjacency.neighbours.push_back(neighbour);
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) adjacency.first[f + 1] += adjacency.first[f];
  return adjacency;
}

double doubled_area(const Mesh& mesh, const glm::uvec3& face) {
  const glm::dvec3 a(mesh.vertices[face.x]);
  return glm::length(
      glm::cross(glm::dvec3(mesh.vertices[face.y]) - a, glm::dvec3(mesh.vertices[face.z]) - a));
}

void turn(glm::uvec3& face) {
  std::swap(face.y, face.z);
}

/// Winds every connected part consistently.
class Winder {
 public:
  Winder(Mesh& mesh, const Adjacency& adjacency)
      : mesh_(mesh),
        adjacency_(adjacency),
        visited_(mesh.faces.size(), false),
        turned_(mesh.faces.size(), false) {}

  std::size_t wind() {
    std::size_t count = 0;
    for (std::uint32_t seed = 0; seed < mesh_.faces.size(); ++seed) {
      if (!visited_[seed]) count += wind_part(seed);
    }
    return count;
  }

 private:
  std::size_t wind_part(std::uint32_t seed) {
    std::vector<std::uint32_t> part{seed};
    visited_[seed] = true;
    bool orientable = true;
    double area[2] = {0, 0};
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::uint32_t face = part[i];
      area[turned_[face] ? 1 : 0] += doubled_area(mesh_, mesh_.faces[face]);
      for (std::uint32_t n = adjacency_.first[face]; n < adjacency_.first[face + 1]; ++n) {
        const auto [other, agrees] = adjacency_.neighbours[n];
        const bool wanted = agrees == turned_[face];
        if (visited_[other]) {
          orientable = orientable && turned_[other] == wanted;
        } else {
          visited_[other] = true;
          turned_[other] = wanted;
          part.push_back(other);
        }
      }
    }
    if (!orientable) return 0;
    const bool keep = area[0] >= area[1];
    std::size_t count = 0;
    for (const std::uint32_t face : part) {
      if (turned_[face] != keep) continue;
      turn(mesh_.faces[face]);
      ++count;
    }
    return count;
  }

  Mesh& mesh_;
  const Adjacency& adjacency_;
  std::vector<bool> visited_;
  std::vector<bool> turned_;
};

double enclosed_volume(const Mesh& mesh) {
  const glm::dvec3 centre = centroid(mesh);
  double volume = 0;
  for (const glm::uvec3& face : mesh.faces) {
    const glm::dvec3 a = glm::dvec3(mesh.vertices[face.x]) - centre;
    const glm::dvec3 b = glm::dvec3(mesh.vertices[face.y]) - centre;
    const glm::dvec3 c = glm::dvec3(mesh.vertices[face.z]) - centre;
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return volume;
}

/// The faces of every part of at least a hundredth of the area; parts have no vertex in common.
std::vector<std::vector<std::uint32_t>> large_parts(const Mesh& mesh) {
  constexpr double kLeastPart = 0.01;
  Components parts(mesh.vertices.size());
  for (const glm::uvec3& face : mesh.faces) {
    parts.unite(face.x, face.y);
    parts.unite(face.x, face.z);
  }
  std::map<std::uint32_t, std::pair<double, std::vector<std::uint32_t>>> by_first_vertex;
  double whole = 0;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    auto& [area, faces] = by_first_vertex[parts.of(mesh.faces[f].x)];
    const double own = doubled_area(mesh, mesh.faces[f]);
    faces.push_back(f);
    area += own;
    whole += own;
  }
  std::vector<std::vector<std::uint32_t>> list;
  for (auto& [vertex, part] : by_first_vertex)
    if (part.first >= kLeastPart * whole) list.push_back(std::move(part.second));
  return list;
}

/// Turns parts of which next to nothing but the back can be seen, with their normals.
/// \return faces turned
std::size_t turn_parts(Mesh& mesh) {
  const auto parts = large_parts(mesh);
  if (parts.size() < 2) return 0;
  std::vector<std::uint32_t> turned;
  {
    const RayScene scene(mesh);
    const double size = diameter(mesh);
    for (const auto& part : parts)
      if (is_inside_out(outlook(submesh(mesh, part), scene, size)))
        turned.insert(turned.end(), part.begin(), part.end());
  }
  std::set<std::uint32_t> vertices;
  for (const std::uint32_t f : turned) {
    for (int k = 0; k < 3; ++k) vertices.insert(mesh.faces[f][k]);
    turn(mesh.faces[f]);
  }
  if (!mesh.normals.empty())
    for (const std::uint32_t v : vertices) mesh.normals[v] = -mesh.normals[v];
  return turned.size();
}

}  // namespace

Turned orient_faces(Mesh& mesh) {
  const Adjacency adjacency = adjacency_of(mesh);
  Turned turned;
  if (!adjacency.consistent) turned.inconsistent = Winder(mesh, adjacency).wind();
  // Of an open surface the volume is only a first guess: a bowl's inside alone has a negative one, too.
  turned.inside_out = enclosed_volume(mesh) < 0 && (adjacency.closed || is_inside_out(outlook(mesh)));
  if (turned.inside_out) {
    for (glm::uvec3& face : mesh.faces) turn(face);
    for (glm::vec3& normal : mesh.normals) normal = -normal;
  }
  turned.of_parts = turn_parts(mesh);
  return turned;
}

}  // namespace rejoin::mesh::detail
