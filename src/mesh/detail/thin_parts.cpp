#include "mesh/detail/thin_parts.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

#include "core/components.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr int kRounds = 2;
constexpr double kIsland = 0.2;  // of the least part's area, at most
constexpr double kLong = 4.0;    // typical edges: a longer face stands for itself

/// A face at an edge.
using Side = std::array<std::uint32_t, 3>;  // lower and higher vertex, face

/// In ascending order: first by the lower vertex, which has few of them.
std::vector<Side> sides_of(const Mesh& mesh) {
  std::vector<std::size_t> first(mesh.vertices.size() + 1, 0);
  const auto for_each_side = [&](const auto& body) {
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax({mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]});
        body(Side{low, high, f});
      }
    }
  };
  for_each_side([&](const Side& side) { ++first[side[0] + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  std::vector<Side> sides(3 * mesh.faces.size());
  for_each_side([&](const Side& side) { sides[next[side[0]]++] = side; });
  for (std::size_t v = 0; v < next.size(); ++v) {
    std::sort(sides.begin() + static_cast<std::ptrdiff_t>(first[v]),
              sides.begin() + static_cast<std::ptrdiff_t>(next[v]));
  }
  return sides;
}

/// Calls body(sides of one edge) for every edge.
template <typename Body>
void for_each_edge(const std::vector<Side>& sides, const Body& body) {
  for (std::size_t k = 0, next = 0; k < sides.size(); k = next) {
    while (next < sides.size() && sides[next][0] == sides[k][0] && sides[next][1] == sides[k][1]) ++next;
    body(std::span(sides).subspan(k, next - k));
  }
}

std::vector<double> areas_of(const Mesh& mesh) {
  std::vector<double> areas;
  areas.reserve(mesh.faces.size());
  for (const glm::uvec3& face : mesh.faces) {
    const glm::dvec3 a(mesh.vertices[face.x]);
    areas.push_back(0.5 * glm::length(glm::cross(glm::dvec3(mesh.vertices[face.y]) - a,
                                                 glm::dvec3(mesh.vertices[face.z]) - a)));
  }
  return areas;
}

double longest_edge(const Mesh& mesh, const glm::uvec3& face) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    longest = std::max(longest, static_cast<double>(
                                    glm::distance(mesh.vertices[face[k]], mesh.vertices[face[(k + 1) % 3]])));
  }
  return longest;
}

/// What most faces around each one are.
std::vector<bool> evened(const Mesh& mesh, const std::vector<bool>& thin) {
  const double large = kLong * resolution(mesh);
  std::vector<float> of_face(thin.begin(), thin.end());
  for (int round = 0; round < kRounds; ++round) {
    std::vector<float> sums(mesh.vertices.size(), 0.0F);
    std::vector<float> counts(mesh.vertices.size(), 0.0F);
    for (std::size_t f = 0; f < of_face.size(); ++f) {
      for (int k = 0; k < 3; ++k) {
        sums[mesh.faces[f][k]] += of_face[f];
        counts[mesh.faces[f][k]] += 1.0F;
      }
    }
    for (std::size_t f = 0; f < of_face.size(); ++f) {
      if (longest_edge(mesh, mesh.faces[f]) > large) continue;
      float sum = 0.0F;
      for (int k = 0; k < 3; ++k) sum += sums[mesh.faces[f][k]] / counts[mesh.faces[f][k]];
      of_face[f] = sum / 3.0F;
    }
  }
  std::vector<bool> result;
  result.reserve(of_face.size());
  for (const float share : of_face) result.push_back(share > 0.5F);
  return result;
}

/// Faces of one kind that hang together across edges.
std::vector<std::uint32_t> numbered(const std::vector<Side>& sides, const std::vector<bool>& thin) {
  Components together(thin.size());
  for_each_edge(sides, [&](std::span<const Side> edge) {
    for (std::size_t i = 0; i < edge.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (thin[edge[i][2]] == thin[edge[j][2]]) together.unite(edge[i][2], edge[j][2]);
      }
    }
  });
  std::vector<std::uint32_t> part(thin.size());
  for (std::uint32_t f = 0; f < part.size(); ++f) part[f] = together.of(f);
  return part;
}

/// Turns what is small, of either kind, and lies beside the other kind.
void turn_islands(const std::vector<Side>& sides, const std::vector<double>& areas, double largest,
                  std::vector<bool>& thin) {
  const std::vector<std::uint32_t> part = numbered(sides, thin);
  std::vector<double> area(part.size(), 0.0);
  std::vector<bool> beside(part.size(), false);
  for (std::size_t f = 0; f < part.size(); ++f) area[part[f]] += areas[f];
  for_each_edge(sides, [&](std::span<const Side> edge) {
    for (std::size_t i = 1; i < edge.size(); ++i) {
      if (thin[edge[i][2]] != thin[edge[0][2]]) beside[part[edge[i][2]]] = beside[part[edge[0][2]]] = true;
    }
  });
  for (std::size_t f = 0; f < part.size(); ++f) {
    if (beside[part[f]] && area[part[f]] < largest) thin[f] = !thin[f];
  }
}

}  // namespace

std::vector<ThinPart> thin_parts(const Mesh& mesh, const std::vector<bool>& thin, double least) {
  const std::vector<Side> sides = sides_of(mesh);
  const std::vector<double> areas = areas_of(mesh);
  std::vector<bool> flagged = evened(mesh, thin);
  turn_islands(sides, areas, kIsland * least, flagged);
  const std::vector<std::uint32_t> part = numbered(sides, flagged);
  std::vector<ThinPart> parts(part.size());
  for (std::uint32_t f = 0; f < part.size(); ++f) {
    if (!flagged[f]) continue;
    parts[part[f]].faces.push_back(f);
    parts[part[f]].area += areas[f];
  }
  for_each_edge(sides, [&](std::span<const Side> edge) {
    const auto own = std::ranges::find_if(edge, [&](const Side& side) { return flagged[side[2]]; });
    if (own == edge.end()) return;
    ThinPart& at = parts[part[(*own)[2]]];
    const auto length =
        static_cast<double>(glm::distance(mesh.vertices[(*own)[0]], mesh.vertices[(*own)[1]]));
    if (edge.size() == 1) {
      at.free += length;
    } else if (!std::ranges::all_of(edge, [&](const Side& side) { return flagged[side[2]]; })) {
      at.attached += length;
      at.seam.emplace_back((*own)[0], (*own)[1]);
    }
  });
  std::erase_if(parts, [&](const ThinPart& one) { return one.area < least; });
  return parts;
}

}  // namespace rejoin::mesh::detail
