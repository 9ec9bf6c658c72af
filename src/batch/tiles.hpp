/// Which pairs a run looks at, and in what order.
#pragma once

#include <cstddef>
#include <vector>

namespace rejoin::batch {

/// One of `count` parts of the work; together they are the whole, and no two share a pair.
struct Shard {
  std::size_t number = 1;  ///< 1 .. count
  std::size_t count = 1;
};

/// All pairs a < b with a in [a_first, a_last) and b in [b_first, b_last).
struct Tile {
  std::size_t a_first;
  std::size_t a_last;
  std::size_t b_first;
  std::size_t b_last;

  std::size_t pairs() const;
  /// Indices of the fragments that it needs, ascending.
  std::vector<std::size_t> fragments() const;
};

/// The shard's pairs of `fragments` fragments, cut into tiles that need few fragments at a time.  Shards differ by about a tenth in
/// their number of pairs where there are many pairs a shard, and a shard needs few fragments.  Pairs close in the list come first: scans
/// that are named by where they were found join their neighbours more often, and every scan has soon been read.  Depends on the arguments alone.
/// \pre 1 <= shard.number <= shard.count
std::vector<Tile> tiles_of(std::size_t fragments, const Shard& shard);

}  // namespace rejoin::batch
