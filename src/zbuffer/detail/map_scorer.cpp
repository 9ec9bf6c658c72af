#include "zbuffer/detail/map_scorer.hpp"

#include <algorithm>
#include <string>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "zbuffer/detail/canvas.hpp"
#include "zbuffer/detail/pair_score.hpp"

namespace rejoin::zbuffer::detail {
namespace {

/// Lanes a thread: enough that threads end together, and that each of a few annealing chains keeps its own
/// maps.
constexpr std::size_t kLanesPerThread = 4;

std::size_t pixel_count(const ViewOptions& options) {
  return static_cast<std::size_t>(options.resolution) * static_cast<std::size_t>(options.resolution);
}

}  // namespace

void MapScorer::score(std::span<const ViewPair> poses, std::span<PairScore> scores) {
  if (poses.size() != scores.size()) {
    throw InputError("scores", "there are " + std::to_string(scores.size()) + " places for " +
                                   std::to_string(poses.size()) + " poses");
  }
  const std::size_t lanes =
      std::min(poses.size(), kLanesPerThread * static_cast<std::size_t>(thread_count()));
  if (lanes_.size() < lanes) lanes_.resize(lanes);
  parallel_for(lanes, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t lane = first; lane < last; ++lane) {
      const std::size_t end = poses.size() * (lane + 1) / lanes;
      for (std::size_t k = poses.size() * lane / lanes; k < end; ++k) {
        scores[k] = score_one(poses[k], lanes_[lane]);
      }
    }
  });
}

PairScore MapScorer::score_one(const ViewPair& pose, Lane& lane) const {
  const float* a = map_of(Side::A, projection_a(pose, options_), lane);
  const float* b = map_of(Side::B, projection_b(pose, options_), lane);
  return pair_score(slope_sums(a, b, options_.resolution, options_.resolution), options_.view_side);
}

const float* MapScorer::map_of(Side side, const Projection& projection, Lane& lane) const {
  auto& slots = lane.slots[side == Side::A ? 0 : 1];
  const std::uint64_t now = ++lane.clock;
  for (Slot& slot : slots) {
    if (!slot.depth.empty() && slot.projection == projection) {
      slot.last_use = now;
      return slot.depth.data();
    }
  }
  Slot& slot = slots[0].last_use <= slots[1].last_use ? slots[0] : slots[1];
  slot.depth.resize(pixel_count(options_));
  clear(slot.depth);
  render(side, projection, slot.depth);
  slot.projection = projection;
  slot.last_use = now;
  return slot.depth.data();
}

DepthMap MapScorer::depth_map(Side side, const Projection& projection) const {
  DepthMap map(options_.resolution, options_.resolution);
  render(side, projection, map.depth);
  return map;
}

std::pair<DepthMap, DepthMap> MapScorer::depth_maps(const ViewPair& pose) {
  return {depth_map(Side::A, projection_a(pose, options_)), depth_map(Side::B, projection_b(pose, options_))};
}

}  // namespace rejoin::zbuffer::detail
