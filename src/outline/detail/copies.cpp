#include "outline/detail/copies.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>

#include "outline/congruence.hpp"

namespace rejoin::outline::detail {

std::vector<AssemblyRepeat> repeats_of(const std::vector<Piece>& pieces, const Assembly& assembly,
                                       const NamesOfPairs& alike) {
  constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> groups;
  for (const Placement& placement : assembly.placements) groups.push_back(placement.group);
  for (const std::size_t piece : assembly.unplaced) groups[piece] = kNowhere;
  const auto is_earlier = [&](std::size_t other, std::size_t piece) {
    return groups[other] < groups[piece] ||
           (groups[piece] == kNowhere && groups[other] == kNowhere && other < piece);
  };
  std::vector<AssemblyRepeat> repeats;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    if (groups[piece] == 0) continue;
    const auto first_where = [&](const auto& is_like) -> std::optional<std::size_t> {
      for (std::size_t other = 0; other < pieces.size(); ++other)
        if (is_earlier(other, piece) && is_like(other)) return other;
      return std::nullopt;
    };
    const auto again = first_where([&](std::size_t o) {
      return alike.count({std::min(piece, o), std::max(piece, o)}) != 0;
    });
    const Outline back = turned_over(pieces[piece].outline);
    const auto of =
        again ? again : first_where([&](std::size_t o) { return congruent(back, pieces[o].outline); });
    if (of) repeats.push_back({piece, *of, !again});
  }
  return repeats;
}

}  // namespace rejoin::outline::detail
