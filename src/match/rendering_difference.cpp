#include "match/rendering_difference.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.hpp"

namespace rejoin::match {
namespace {

using zbuffer::DepthMap;
using Maps = std::pair<DepthMap, DepthMap>;

/// What the map itself tells of a covered pixel.
PixelKind kind_of(const DepthMap& map, int i, int j, double pixel) {
  double steepest = 0;
  for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const int x = i + di;
    const int y = j + dj;
    if (x < 0 || y < 0 || x >= map.width || y >= map.height) continue;
    if (std::isnan(map.at(x, y))) return PixelKind::Silhouette;
    steepest = std::max(steepest, std::abs(static_cast<double>(map.at(x, y)) - map.at(i, j)) / pixel);
  }
  return steepest > kSteepSlope ? PixelKind::Steep : PixelKind::Interior;
}

/// The kind of each pixel that either rendering covers (the first in the order of PixelKind, if they do not
/// agree).
std::vector<PixelKind> kinds_of(const DepthMap& first, const DepthMap& second, double pixel) {
  std::vector<PixelKind> result(first.depth.size(), PixelKind::Interior);
  for (int j = 0; j < first.height; ++j) {
    for (int i = 0; i < first.width; ++i) {
      const bool in_first = !std::isnan(first.at(i, j));
      const bool in_second = !std::isnan(second.at(i, j));
      PixelKind& kind = result[static_cast<std::size_t>(j) * first.width + i];
      if (in_first != in_second) kind = PixelKind::Silhouette;
      if (in_first && in_second) kind = std::min(kind_of(first, i, j, pixel), kind_of(second, i, j, pixel));
    }
  }
  return result;
}

DepthMap difference_of(const DepthMap& first, const DepthMap& second) {
  DepthMap result(first.width, first.height);  // NaN - x = NaN: background unless both are covered
  for (std::size_t k = 0; k < result.depth.size(); ++k) result.depth[k] = first.depth[k] - second.depth[k];
  return result;
}

/// Counts one fragment's pixels into the kinds.  depth_mean and depth_share hold sums until finish().
void count_depths(const DepthMap& first, const DepthMap& second, const std::vector<PixelKind>& kinds,
                  RenderingDifference& result) {
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const bool in_first = !std::isnan(first.depth[k]);
    const bool in_second = !std::isnan(second.depth[k]);
    if (!in_first && !in_second) continue;
    KindShare& share = result.kinds[static_cast<std::size_t>(kinds[k])];
    ++share.pixels;
    result.only_first += in_first && !in_second ? 1 : 0;
    result.only_second += in_second && !in_first ? 1 : 0;
    if (!in_first || !in_second) continue;
    const double difference = std::abs(static_cast<double>(first.depth[k]) - second.depth[k]);
    share.depth_mean += 1;  // number of pixels that both cover
    share.depth_max = std::max(share.depth_max, difference);
    share.depth_share += difference;
  }
}

/// Sums |change of the slope difference| by the worst kind of the pixels that it is made from.
void count_errors(const DepthMap& first, const DepthMap& second, const std::vector<PixelKind>& kinds_a,
                  const std::vector<PixelKind>& kinds_b, RenderingDifference& result) {
  const int width = first.width;
  const auto at = [width](const std::vector<PixelKind>& kinds, int i, int j) {
    return kinds[static_cast<std::size_t>(j) * width + i];
  };
  for (int j = 0; j + 1 < first.height; ++j) {
    for (int i = 0; i + 1 < width; ++i) {
      const float one = first.at(i, j);
      const float other = second.at(i, j);
      if (std::isnan(one) && std::isnan(other)) continue;
      const int m = width - 1 - i;
      const PixelKind kind = std::min({at(kinds_a, i, j), at(kinds_a, i + 1, j), at(kinds_a, i, j + 1),
                                       at(kinds_b, m, j), at(kinds_b, m - 1, j), at(kinds_b, m, j + 1)});
      const double change = std::isnan(one) ? other : std::isnan(other) ? one : std::abs(one - other);
      result.kinds[static_cast<std::size_t>(kind)].error_share += change;
    }
  }
}

/// Turns the sums into means and shares.
void finish(std::array<KindShare, kPixelKinds>& kinds) {
  double depth = 0;
  double error = 0;
  for (const KindShare& kind : kinds) {
    depth += kind.depth_share;
    error += kind.error_share;
  }
  for (KindShare& kind : kinds) {
    kind.depth_mean = kind.depth_mean > 0 ? kind.depth_share / kind.depth_mean : 0;
    kind.depth_share = depth > 0 ? kind.depth_share / depth : 0;
    kind.error_share = error > 0 ? kind.error_share / error : 0;
  }
}

}  // namespace

RenderingDifference rendering_difference(const Maps& first, const Maps& second, double view_side) {
  const auto shape = [](const DepthMap& map) { return std::pair{map.width, map.height}; };
  for (const DepthMap* map : {&first.second, &second.first, &second.second}) {
    if (shape(*map) != shape(first.first))
      throw InputError("depth maps", "the shapes of the renderings differ");
  }
  const double pixel = view_side / first.first.width;
  RenderingDifference result;
  result.depth_a = difference_of(first.first, second.first);
  result.depth_b = difference_of(first.second, second.second);
  const DepthMap error_first = zbuffer::slope_difference_map(first.first, first.second, view_side);
  const DepthMap error_second = zbuffer::slope_difference_map(second.first, second.second, view_side);
  result.error = difference_of(error_first, error_second);
  result.score_first = zbuffer::slope_difference(first.first, first.second, view_side);
  result.score_second = zbuffer::slope_difference(second.first, second.second, view_side);
  const std::vector<PixelKind> kinds_a = kinds_of(first.first, second.first, pixel);
  const std::vector<PixelKind> kinds_b = kinds_of(first.second, second.second, pixel);
  count_depths(first.first, second.first, kinds_a, result);
  count_depths(first.second, second.second, kinds_b, result);
  count_errors(error_first, error_second, kinds_a, kinds_b, result);
  finish(result.kinds);
  return result;
}

}  // namespace rejoin::match
