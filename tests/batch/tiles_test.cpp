#include "batch/tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace rejoin::batch {
namespace {

using IndexPair = std::pair<std::size_t, std::size_t>;

std::vector<IndexPair> pairs_of(const std::vector<Tile>& tiles) {
  std::vector<IndexPair> pairs;
  for (const Tile& tile : tiles) {
    std::size_t count = 0;
    for (std::size_t a = tile.a_first; a < tile.a_last; ++a) {
      for (std::size_t b = std::max(a + 1, tile.b_first); b < tile.b_last; ++b) {
        pairs.emplace_back(a, b);
        ++count;
      }
    }
    EXPECT_EQ(count, tile.pairs());
  }
  return pairs;
}

TEST(Tiles, ShardsTogetherAreEveryPairOnce) {
  for (const std::size_t fragments : {2U, 3U, 10U, 21U, 49U, 130U}) {
    for (const std::size_t shards : {1U, 2U, 7U, 8U, 60U}) {
      std::map<IndexPair, int> seen;
      for (std::size_t number = 1; number <= shards; ++number) {
        for (const IndexPair& pair : pairs_of(tiles_of(fragments, {number, shards}))) ++seen[pair];
      }
      EXPECT_EQ(seen.size(), fragments * (fragments - 1) / 2) << fragments << " in " << shards;
      for (const auto& [pair, times] : seen) EXPECT_EQ(times, 1);
    }
  }
}

TEST(Tiles, FragmentsAreThoseOfThePairs) {
  for (const Tile& tile : tiles_of(130, {3, 8})) {
    std::set<std::size_t> needed;
    for (const auto& [a, b] : pairs_of({tile})) needed.insert({a, b});
    const std::vector<std::size_t> told = tile.fragments();
    EXPECT_EQ(std::vector<std::size_t>(needed.begin(), needed.end()), told);
  }
}

TEST(Tiles, LargeShardsAreNearlyEqual) {
  constexpr std::size_t kFragments = 3000;
  constexpr std::size_t kShards = 100;
  const double fair = kFragments * (kFragments - 1) / 2.0 / kShards;
  for (std::size_t number = 1; number <= kShards; ++number) {
    double pairs = 0;
    for (const Tile& tile : tiles_of(kFragments, {number, kShards}))
      pairs += static_cast<double>(tile.pairs());
    EXPECT_NEAR(pairs, fair, 0.12 * fair) << number;
  }
}

TEST(Tiles, CloseFragmentsAreFirst) {
  for (const Shard& shard : {Shard{1, 1}, Shard{2, 3}}) {
    std::size_t farthest = 0;
    for (const Tile& tile : tiles_of(1000, shard)) {
      EXPECT_GE(tile.b_first - tile.a_first, farthest);
      farthest = tile.b_first - tile.a_first;
    }
    EXPECT_GT(farthest, 300U);
  }
}

TEST(Tiles, NoTileNeedsManyFragments) {
  for (const Tile& tile : tiles_of(1000, {1, 1})) EXPECT_LE(tile.fragments().size(), 96U);
}

}  // namespace
}  // namespace rejoin::batch
