#include "mesh/bodies.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>

#include "core/components.hpp"
#include "mesh/detail/directions.hpp"
#include "mesh/detail/parts.hpp"

namespace rejoin::mesh {
namespace {

constexpr double kLarge = 0.05;  // of the whole area: a part that may be a body
constexpr double kFlat = 0.95;   // of a part's area that is left of it when looked at from the front: a sheet
constexpr double kRoom = 0.02;   // between bodies, of the diagonal of the smaller one's box
constexpr double kBack = 0.3;    // of a part's area, by which it faces away from the other
constexpr std::size_t kDirections = 300;

/// A part that may be a body, with its vertices.
struct Block {
  detail::Part part;
  std::vector<glm::vec3> corners;  // of its faces, each as often as it is used
};

std::vector<Block> blocks_of(const Mesh& mesh, double& all) {
  const std::vector<std::uint32_t> part_of_face = detail::part_of_faces(mesh);
  const std::vector<detail::Part> parts = detail::measured_parts(mesh, part_of_face);
  all = 0;
  for (const detail::Part& part : parts) all += part.weight;
  std::vector<std::size_t> block_of(parts.size(), parts.size());
  std::vector<Block> blocks;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k].weight < kLarge * all || glm::length(parts[k].facing) > kFlat * parts[k].weight) continue;
    block_of[k] = blocks.size();
    blocks.push_back({parts[k], {}});
  }
  if (blocks.size() < 2) return blocks;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::size_t block = block_of[part_of_face[f]];
    if (block == parts.size()) continue;
    for (int k = 0; k < 3; ++k) blocks[block].corners.push_back(mesh.vertices[mesh.faces[f][k]]);
  }
  return blocks;
}

struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

Span span_along(const Block& block, const glm::vec3& up) {
  Span span;
  for (const glm::vec3& corner : block.corners) {
    const double height = glm::dot(corner, up);
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

/// Which blocks are one body; plane by plane, as a plane parts all that it lies between.
class Apart {
 public:
  explicit Apart(const std::vector<Block>& blocks)
      : blocks_(blocks), apart_(blocks.size(), std::vector<bool>(blocks.size(), false)) {}

  void look_along(const glm::vec3& up) {
    std::vector<Span> spans;
    for (const Block& block : blocks_) spans.push_back(span_along(block, up));
    for (std::size_t a = 0; a < blocks_.size(); ++a) {
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        if (lies_above(blocks_[a], blocks_[b], spans[b].low - spans[a].high, glm::dvec3(up)))
          apart_[a][b] = apart_[b][a] = true;
      }
    }
  }

  Components together() const {
    Components result(blocks_.size());
    for (std::uint32_t a = 0; a < blocks_.size(); ++a) {
      for (std::uint32_t b = 0; b < a; ++b) {
        if (!apart_[a][b]) result.unite(a, b);
      }
    }
    return result;
  }

 private:
  const std::vector<Block>& blocks_;
  std::vector<std::vector<bool>> apart_;
};

}  // namespace

std::vector<double> bodies(const Mesh& mesh) {
  double all = 0;
  const std::vector<Block> blocks = blocks_of(mesh, all);
  if (blocks.size() < 2) return {};
  Apart apart(blocks);
  for (const glm::vec3& direction : detail::half_sphere_directions(kDirections)) apart.look_along(direction);
  Components together = apart.together();
  std::vector<double> shares(blocks.size(), 0.0);
  for (std::uint32_t k = 0; k < blocks.size(); ++k) shares[together.of(k)] += blocks[k].part.weight / all;
  std::erase(shares, 0.0);
  std::ranges::sort(shares, std::greater());
  return shares;
}

}  // namespace rejoin::mesh
