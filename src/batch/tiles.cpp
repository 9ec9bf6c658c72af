#include "batch/tiles.hpp"

#include <algorithm>
#include <cmath>

namespace rejoin::batch {
namespace {

constexpr std::size_t kMostInBlock = 48;   // two blocks of prepared scans of 100,000 faces fit into 2 GB
constexpr std::size_t kTilesOfShard = 10;  // so that shards come out nearly equal

/// Fragments a block, so that the triangle of blocks has enough tiles to deal out.
std::size_t block_size(std::size_t fragments, std::size_t shards) {
  if (shards == 1) return kMostInBlock;
  const double blocks = std::sqrt(2.0 * static_cast<double>(kTilesOfShard * shards));
  const auto size = static_cast<std::size_t>(static_cast<double>(fragments) / blocks);
  return std::clamp<std::size_t>(size, 1, kMostInBlock);
}

std::size_t pairs_among(std::size_t count) {
  return count < 2 ? 0 : count * (count - 1) / 2;
}

}  // namespace

std::size_t Tile::pairs() const {
  if (a_first == b_first) return pairs_among(a_last - a_first);
  return (a_last - a_first) * (b_last - b_first);
}

std::vector<std::size_t> Tile::fragments() const {
  std::vector<std::size_t> list;
  list.reserve(a_last - a_first + b_last - b_first);
  for (std::size_t k = a_first; k < a_last; ++k) list.push_back(k);
  for (std::size_t k = std::max(a_last, b_first); k < b_last; ++k) list.push_back(k);
  return list;
}

std::vector<Tile> tiles_of(std::size_t fragments, const Shard& shard) {
  const std::size_t size = block_size(fragments, shard.count);
  const std::size_t blocks = (fragments + size - 1) / size;
  const auto total = static_cast<double>(pairs_among(fragments));
  std::vector<Tile> tiles;
  std::size_t before = 0;
  for (std::size_t i = 0; i < blocks; ++i) {
    for (std::size_t j = i; j < blocks; ++j) {
      const Tile tile{i * size, std::min(fragments, (i + 1) * size), j * size,
                      std::min(fragments, (j + 1) * size)};
      const std::size_t pairs = tile.pairs();
      if (pairs == 0) continue;
      const double middle = static_cast<double>(before) + 0.5 * static_cast<double>(pairs);
      const auto owner = static_cast<std::size_t>(middle / total * static_cast<double>(shard.count));
      if (std::min(owner, shard.count - 1) + 1 == shard.number) tiles.push_back(tile);
      before += pairs;
    }
  }
  std::stable_sort(tiles.begin(), tiles.end(), [](const Tile& x, const Tile& y) {
    return x.b_first - x.a_first < y.b_first - y.a_first;
  });
  return tiles;
}

}  // namespace rejoin::batch
