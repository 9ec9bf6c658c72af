#include "mesh/bodies.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>

#include "core/components.hpp"
#include "mesh/detail/apart.hpp"

namespace rejoin::mesh {
namespace {

constexpr double kLarge = 0.05;  // of the whole area: a part that may be a body
constexpr double kFlat = 0.95;   // of a part's area that is left of it when looked at from the front: a sheet

std::vector<detail::Block> blocks_of(const Mesh& mesh, double& all) {
  const std::vector<std::uint32_t> part_of_face = detail::part_of_faces(mesh);
  const std::vector<detail::Part> parts = detail::measured_parts(mesh, part_of_face);
  all = 0;
  for (const detail::Part& part : parts) all += part.weight;
  std::vector<bool> large(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    large[k] = parts[k].weight >= kLarge * all && glm::length(parts[k].facing) <= kFlat * parts[k].weight;
  }
  std::vector<detail::Block> blocks;
  if (std::ranges::count(large, true) < 2) return blocks;
  const std::vector<std::vector<std::uint32_t>> faces = detail::members_of_parts(part_of_face, parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (large[k]) blocks.push_back({parts[k], submesh(mesh, faces[k])});
  }
  return blocks;
}

}  // namespace

std::vector<double> bodies(const Mesh& mesh) {
  double all = 0;
  const std::vector<detail::Block> blocks = blocks_of(mesh, all);
  if (blocks.empty()) return {};
  const detail::Apart apart = detail::apart_by_planes(blocks);
  Components together(blocks.size());
  for (std::uint32_t a = 0; a < blocks.size(); ++a) {
    for (std::uint32_t b = 0; b < a; ++b) {
      if (!apart[a][b] && !detail::are_two_closed(blocks[a], blocks[b])) together.unite(a, b);
    }
  }
  std::vector<double> shares(blocks.size(), 0.0);
  for (std::uint32_t k = 0; k < blocks.size(); ++k) shares[together.of(k)] += blocks[k].part.weight / all;
  std::erase(shares, 0.0);
  std::ranges::sort(shares, std::greater());
  return shares;
}

}  // namespace rejoin::mesh
