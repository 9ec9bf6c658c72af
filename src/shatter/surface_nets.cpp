#include "shatter/surface_nets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <unordered_map>

#include "core/parallel.hpp"

namespace rejoin::shatter {
namespace {

constexpr int kSide = 4;              // cells across a block
constexpr int kNodes = kSide + 1;     // its nodes include those shared with the next block
constexpr std::size_t kRow = kNodes;  // of nodes
constexpr std::size_t kAllNodes = kRow * kRow * kRow;
constexpr int kBlocks = 8;         // blocks across a group
constexpr double kSteepest = 1.2;  // the field's assumed steepest slope; what it misses, neighbours bring in
constexpr double kHalfDiagonal = 0.8660254037844386;

std::uint64_t key_of(const glm::ivec3& cell) {
  const auto part = [](int v) { return static_cast<std::uint64_t>(v) & 0x1fffffU; };
  return (part(cell.x) << 42U) | (part(cell.y) << 21U) | part(cell.z);
}

struct Block {
  glm::ivec3 at{0};  ///< number of the block along each axis
  std::array<float, kAllNodes> values{};

  static std::size_t slot(const glm::ivec3& node) {
    return (static_cast<std::size_t>(node.x) * kRow + static_cast<std::size_t>(node.y)) * kRow +
           static_cast<std::size_t>(node.z);
  }
  float value(const glm::ivec3& node) const { return values[slot(node)]; }
};

class Nets {
 public:
  Nets(const Field& field, const Grid& grid) : field_(field), grid_(grid) {
    across_ = static_cast<int>(std::ceil(grid.size / grid.spacing / kSide)) + 1;
  }

  bool fill(const Context& context) {
    std::vector<glm::ivec3> wanted = near_surface(groups(), context);
    while (!wanted.empty()) {
      if (context.cancelled()) return false;
      evaluate(wanted);
      wanted = missing_neighbours(blocks_.size() - wanted.size());
    }
    return true;
  }

  mesh::Mesh mesh() {
    mesh::Mesh result;
    result.origin = grid_.centre;
    for (const Block& block : blocks_) add_vertices(block, result);
    for (const Block& block : blocks_) add_faces(block, result);
    return result;
  }

 private:
  glm::dvec3 position(const glm::dvec3& node) const {
    return grid_.centre + grid_.axes * (grid_.spacing * (node - 0.5 * kSide * across_));
  }

  std::vector<glm::ivec3> groups() const {
    const int count = (across_ + kBlocks - 1) / kBlocks;
    std::vector<glm::ivec3> all;
    for (int x = 0; x < count; ++x)
      for (int y = 0; y < count; ++y)
        for (int z = 0; z < count; ++z) all.emplace_back(x, y, z);
    return near(all, kSide * kBlocks);
  }

  /// Of cubes of `side` cells, numbered from 0, those that the surface may pass through.
  std::vector<glm::ivec3> near(const std::vector<glm::ivec3>& cubes, int side) const {
    const double reach = kSteepest * kHalfDiagonal * side * grid_.spacing;
    std::vector<char> keep(cubes.size(), 0);
    parallel_for(cubes.size(), 64, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) {
        const glm::dvec3 middle = static_cast<double>(side) * (glm::dvec3(cubes[k]) + 0.5);
        keep[k] = std::abs(field_(position(middle))) <= reach ? 1 : 0;
      }
    });
    std::vector<glm::ivec3> result;
    for (std::size_t k = 0; k < cubes.size(); ++k) {
      if (keep[k] != 0) result.push_back(cubes[k]);
    }
    return result;
  }

  std::vector<glm::ivec3> near_surface(const std::vector<glm::ivec3>& groups, const Context& context) const {
    std::vector<glm::ivec3> result;
    for (const glm::ivec3& group : groups) {
      if (context.cancelled()) return {};
      std::vector<glm::ivec3> blocks;
      blocks.reserve(static_cast<std::size_t>(kBlocks) * kBlocks * kBlocks);
      for (int x = 0; x < kBlocks; ++x)
        for (int y = 0; y < kBlocks; ++y)
          for (int z = 0; z < kBlocks; ++z) blocks.push_back(kBlocks * group + glm::ivec3(x, y, z));
      blocks = near(blocks, kSide);
      result.insert(result.end(), blocks.begin(), blocks.end());
    }
    return result;
  }

  void evaluate(const std::vector<glm::ivec3>& wanted) {
    const std::size_t begin = blocks_.size();
    for (const glm::ivec3& at : wanted) {
      number_[key_of(at)] = blocks_.size();
      blocks_.emplace_back().at = at;
    }
    parallel_for(wanted.size(), 8, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = begin + first; k < begin + last; ++k) {
        Block& block = blocks_[k];
        for (int n = 0; n < kNodes * kNodes * kNodes; ++n) {
          const glm::ivec3 node(n / (kNodes * kNodes), n / kNodes % kNodes, n % kNodes);
          block.values[static_cast<std::size_t>(n)] =
              static_cast<float>(field_(position(glm::dvec3(kSide * block.at + node))));
        }
      }
    });
  }

  /// Blocks that share a crossed side with one evaluated since `from` and are not there yet.
  std::vector<glm::ivec3> missing_neighbours(std::size_t from) const {
    std::set<std::array<int, 3>> missing;
    for (std::size_t k = from; k < blocks_.size(); ++k) {
      for (int side = 0; side < 27; ++side) {
        const glm::ivec3 step(side / 9 - 1, side / 3 % 3 - 1, side % 3 - 1);
        const glm::ivec3 next = blocks_[k].at + step;
        if (step == glm::ivec3(0) || number_.count(key_of(next)) != 0) continue;
        if (crossed(blocks_[k], step)) missing.insert({next.x, next.y, next.z});
      }
    }
    std::vector<glm::ivec3> list;
    list.reserve(missing.size());
    for (const auto& m : missing) list.emplace_back(m[0], m[1], m[2]);
    return list;
  }

  /// Whether the field changes its sign on the side (edge, corner) that faces `step`.
  static bool crossed(const Block& block, const glm::ivec3& step) {
    bool inside = false;
    bool outside = false;
    for (int n = 0; n < kNodes * kNodes * kNodes; ++n) {
      const glm::ivec3 node(n / (kNodes * kNodes), n / kNodes % kNodes, n % kNodes);
      bool on = true;
      for (int a = 0; a < 3; ++a) {
        if (step[a] < 0) on = on && node[a] <= 1;
        if (step[a] > 0) on = on && node[a] >= kSide - 1;
      }
      if (!on) continue;
      (block.value(node) < 0 ? inside : outside) = true;
    }
    return inside && outside;
  }

  void add_vertices(const Block& block, mesh::Mesh& result) {
    for (int c = 0; c < kSide * kSide * kSide; ++c) {
      const glm::ivec3 cell(c / (kSide * kSide), c / kSide % kSide, c % kSide);
      glm::dvec3 sum(0.0);
      int crossings = 0;
      for (int axis = 0; axis < 3; ++axis) {
        for (int corner = 0; corner < 4; ++corner) {
          glm::ivec3 start = cell;
          start[(axis + 1) % 3] += corner & 1;
          start[(axis + 2) % 3] += corner >> 1;
          glm::ivec3 end = start;
          ++end[axis];
          const double low = static_cast<double>(block.value(start));
          const double high = static_cast<double>(block.value(end));
          if ((low < 0) == (high < 0)) continue;
          glm::dvec3 crossing(start);
          crossing[axis] += low / (low - high);
          sum += crossing;
          ++crossings;
        }
      }
      if (crossings == 0) continue;
      vertex_[key_of(kSide * block.at + cell)] = static_cast<std::uint32_t>(result.vertices.size());
      const glm::dvec3 node = glm::dvec3(kSide * block.at) + sum / static_cast<double>(crossings);
      result.vertices.emplace_back(position(node) - grid_.centre);
    }
  }

  void add_faces(const Block& block, mesh::Mesh& result) const {
    for (int c = 0; c < kSide * kSide * kSide; ++c) {
      const glm::ivec3 cell(c / (kSide * kSide), c / kSide % kSide, c % kSide);
      for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 end = cell;
        ++end[axis];
        const bool inside = block.value(cell) < 0;
        if (inside == (block.value(end) < 0)) continue;
        add_quad(kSide * block.at + cell, axis, inside, result);
      }
    }
  }

  /// Around the edge that leaves node `at` along `axis`; outwards is along the axis if the node is inside.
  void add_quad(const glm::ivec3& at, int axis, bool outwards, mesh::Mesh& result) const {
    glm::ivec3 u(0);
    glm::ivec3 v(0);
    u[(axis + 1) % 3] = 1;
    v[(axis + 2) % 3] = 1;
    const std::array<glm::ivec3, 4> cells{at - u - v, at - v, at, at - u};
    std::array<std::uint32_t, 4> corner{};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto found = vertex_.find(key_of(cells[k]));
      if (found == vertex_.end()) return;  // at the border of the looked-at cube
      corner[k] = found->second;
    }
    if (!outwards) std::swap(corner[1], corner[3]);
    result.faces.emplace_back(corner[0], corner[1], corner[2]);
    result.faces.emplace_back(corner[0], corner[2], corner[3]);
  }

  const Field& field_;
  const Grid& grid_;
  int across_ = 0;  ///< blocks
  std::vector<Block> blocks_;
  std::unordered_map<std::uint64_t, std::size_t> number_;    ///< of a block, by its place
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_;  ///< of a cell
};

}  // namespace

mesh::Mesh surface_nets(const Field& field, const Grid& grid, const Context& context) {
  Nets nets(field, grid);
  if (!nets.fill(context)) return {};
  return nets.mesh();
}

}  // namespace rejoin::shatter
