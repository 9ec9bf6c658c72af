#include "outline/shared_border.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/median.hpp"
#include "core/parallel.hpp"
#include "outline/signal.hpp"

namespace rejoin::outline {
namespace {

// Samples of a border within the reach.
constexpr double kSamplesAReach = 4.0;
// Borders meet within this many times their usual distance.
constexpr double kUsualDistances = 5.0;
constexpr double kLeastReach = 1.0 / 3.0;
// Shorter borders of holes are specks, reaches.
constexpr double kShortestHole = 10.0;

/// Samples of all members' borders in the object's frame.
struct Samples {
  std::vector<glm::dvec2> points;
  std::vector<std::size_t> owners;
  std::vector<double> shares;  // border length that a sample stands for
};

Samples sampled(const std::vector<Piece>& pieces, const std::vector<std::size_t>& members,
                const std::vector<Planar>& poses, double step) {
  Samples samples;
  for (const std::size_t piece : members) {
    const Outline& outline = pieces[piece].outline;
    for (const std::size_t number : long_borders(outline, kShortestHole * kSamplesAReach * step)) {
      const std::vector<glm::dvec2>& border = border_of(outline, number);
      const std::vector<glm::dvec2> points = resample_by(border, step);
      const double share = perimeter(border) / static_cast<double>(points.size());
      for (const glm::dvec2& point : points) samples.points.push_back(poses[piece](point));
      samples.owners.resize(samples.points.size(), piece);
      samples.shares.resize(samples.points.size(), share);
    }
  }
  return samples;
}

/// Finds the nearest sample of another piece.
class Cells {
 public:
  Cells(const Samples& samples, double reach) : samples_(samples), reach_(reach) {
    for (std::size_t i = 0; i < samples.points.size(); ++i)
      cells_[key(column(samples.points[i].x), column(samples.points[i].y))].push_back(i);
  }

  /// nullopt: none within reach.
  std::optional<std::pair<std::size_t, double>> nearest(std::size_t sample) const {
    const glm::dvec2& point = samples_.points[sample];
    std::optional<std::pair<std::size_t, double>> best;
    for (std::int64_t x = column(point.x) - 1; x <= column(point.x) + 1; ++x) {
      for (std::int64_t y = column(point.y) - 1; y <= column(point.y) + 1; ++y) {
        const auto cell = cells_.find(key(x, y));
        if (cell == cells_.end()) continue;
        for (const std::size_t other : cell->second) {
          if (samples_.owners[other] == samples_.owners[sample]) continue;
          const double distance = glm::distance(point, samples_.points[other]);
          if (distance <= reach_ && (!best || distance < best->second)) best = {other, distance};
        }
      }
    }
    return best;
  }

 private:
  std::int64_t column(double x) const { return static_cast<std::int64_t>(std::floor(x / reach_)); }
  static std::uint64_t key(std::int64_t x, std::int64_t y) {
    return static_cast<std::uint64_t>(x) << 32U ^ (static_cast<std::uint64_t>(y) & 0xffffffffU);
  }

  const Samples& samples_;
  double reach_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

}  // namespace

std::vector<SharedBorder> shared_borders(const std::vector<Piece>& pieces,
                                         const std::vector<std::size_t>& members,
                                         const std::vector<Planar>& poses, double reach) {
  const Samples samples = sampled(pieces, members, poses, reach / kSamplesAReach);
  const Cells cells(samples, reach);
  std::vector<std::optional<std::pair<std::size_t, double>>> nearest(samples.points.size());
  parallel_for(nearest.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) nearest[i] = cells.nearest(i);
  });
  std::vector<double> distances;
  for (const auto& found : nearest)
    if (found) distances.push_back(found->second);
  const double limit = std::clamp(kUsualDistances * median(distances), kLeastReach * reach, reach);
  std::map<std::pair<std::size_t, std::size_t>, SharedBorder> shared;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (!nearest[i] || nearest[i]->second > limit) continue;
    const auto [a, b] = std::minmax(samples.owners[i], samples.owners[nearest[i]->first]);
    SharedBorder& border = shared[{a, b}];
    border.length += samples.shares[i];
    border.rms += samples.shares[i] * nearest[i]->second * nearest[i]->second;
  }
  std::vector<SharedBorder> result;
  result.reserve(shared.size());
  for (const auto& [pair, border] : shared)
    result.push_back({pair.first, pair.second, 0.5 * border.length, std::sqrt(border.rms / border.length)});
  return result;
}

}  // namespace rejoin::outline
