#include "shatter/closed_holes.hpp"

#include <cstddef>

#include "mesh/rings.hpp"

namespace rejoin::shatter {
namespace {

constexpr int kSweeps = 500;  // patches of 30 edges across are at rest by then

/// Adds a vertex and those around it that may belong to its patch, as far as they hang together.
void add_patch(std::uint32_t middle, double radius, const mesh::Mesh& scan, const mesh::Rings& rings,
               std::vector<std::uint8_t>& open, std::vector<std::uint32_t>& patches) {
  std::size_t next = patches.size();
  patches.push_back(middle);
  open[middle] = 0;
  for (; next < patches.size(); ++next) {
    for (const std::uint32_t v : rings.of(patches[next])) {
      if (open[v] == 0 ||
          glm::distance(scan.vertices[v], scan.vertices[middle]) >= static_cast<float>(radius))
        continue;
      open[v] = 0;
      patches.push_back(v);
    }
  }
}

/// Moves every vertex to the middle of its ring until all are there.
void relax(mesh::Mesh& scan, const std::vector<std::uint32_t>& patches, const mesh::Rings& rings) {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const std::uint32_t v : patches) {
      glm::vec3 sum(0.0F);
      for (const std::uint32_t k : rings.of(v)) sum += scan.vertices[k];
      scan.vertices[v] = sum / static_cast<float>(rings.of(v).size());
    }
  }
}

}  // namespace

void close_holes(mesh::Mesh& scan, std::vector<std::uint8_t> open, double share, double radius,
                 Random& random) {
  std::vector<std::uint32_t> left;
  for (std::uint32_t v = 0; v < open.size(); ++v)
    if (open[v] != 0) left.push_back(v);
  const auto wanted = static_cast<std::size_t>(share * static_cast<double>(left.size()));
  const mesh::Rings rings(scan);
  std::vector<std::uint32_t> patches;
  while (patches.size() < wanted) {
    std::uint32_t& drawn = left[random.below(static_cast<std::uint32_t>(left.size()))];
    const std::uint32_t middle = drawn;
    drawn = left.back();
    left.pop_back();
    if (open[middle] != 0) add_patch(middle, radius * random.uniform(0.5, 1.0), scan, rings, open, patches);
  }
  relax(scan, patches, rings);
}

}  // namespace rejoin::shatter
