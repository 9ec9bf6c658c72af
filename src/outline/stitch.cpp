#include "outline/stitch.hpp"

#include <algorithm>
#include <cmath>

#include "outline/detail/clip.hpp"

namespace rejoin::outline {
namespace {

/// How many points of B are looked at for the next point of A, beyond those that were missed.
constexpr std::uint32_t kAhead = 4;

/// Grows one end of a seam.
class SeamWalk {
 public:
  SeamWalk(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b, const Planar& pose,
           const SeamOptions& options)
      : a_(a), b_(b), pose_(pose), options_(options) {}

  /// Pairs after `start` (which is left out), going forward or backward along A.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> grow(std::pair<std::uint32_t, std::uint32_t> start,
                                                            bool forward) const {
    const auto n = static_cast<std::uint32_t>(a_.size());
    const auto m = static_cast<std::uint32_t>(b_.size());
    const std::uint32_t step_a = forward ? 1 : n - 1;
    const std::uint32_t step_b = forward == pose_.flipped ? 1 : m - 1;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    std::uint32_t i = start.first;
    std::uint32_t j = start.second;
    std::uint32_t used = 0;
    int misses = 0;
    for (std::uint32_t steps = 1; steps < n && misses < options_.misses; ++steps) {
      i = (i + step_a) % n;
      const std::uint32_t reach = std::min(kAhead + 2 * static_cast<std::uint32_t>(misses), m - 1 - used);
      std::uint32_t best = 0;
      double least = distance(i, j);
      for (std::uint32_t k = 1; k <= reach; ++k) {
        const double d = distance(i, (j + k * step_b) % m);
        if (d >= least) continue;
        least = d;
        best = k;
      }
      if (least > options_.tolerance) {
        ++misses;
        continue;
      }
      misses = 0;
      used += best;
      j = (j + best * step_b) % m;
      pairs.emplace_back(i, j);
    }
    return pairs;
  }

  /// Distance of B's point outside A at A's point, along A's normal.
  double outside(std::uint32_t i, std::uint32_t j) const {
    const std::size_t n = a_.size();
    const glm::dvec2 along = a_[(i + 2) % n] - a_[(i + n - 2) % n];
    const double length = glm::length(along);
    if (length <= 0.0) return 0.0;
    const glm::dvec2 d = pose_(b_[j]) - a_[i];
    return (along.y * d.x - along.x * d.y) / length;
  }

 private:
  double distance(std::uint32_t i, std::uint32_t j) const { return glm::distance(a_[i], pose_(b_[j])); }

  const std::vector<glm::dvec2>& a_;
  const std::vector<glm::dvec2>& b_;
  const Planar& pose_;
  const SeamOptions& options_;
};

detail::Region region_of(const Outline& outline) {
  detail::Region region{outline.points};
  region.insert(region.end(), outline.holes.begin(), outline.holes.end());
  return region;
}

/// The points of a closed polygon from `begin` forward for `length`, with all corners between.
detail::Polygon stretch_of(const detail::Polygon& polygon, double begin, double length) {
  const std::vector<double> lengths = arc_lengths(polygon);
  const double total = lengths.back();
  const double from = begin - std::floor(begin / total) * total;
  const double to = from + std::min(length, total);
  detail::Polygon points{point_at(polygon, lengths, from)};
  for (const double turn : {0.0, total}) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const double at = lengths[i] + turn;
      if (at > from && at < to) points.push_back(polygon[i]);
    }
  }
  points.push_back(point_at(polygon, lengths, to));
  return points;
}

/// What the two stretches of a boundary enclose: all along A's and back along B's.
detail::Polygon strip_between(const Outline& a, const Outline& b, const JoinCandidate& join) {
  const Boundary& met = join.boundary;
  detail::Polygon strip = stretch_of(border_of(a, met.hole_a), met.begin_a, met.length_a());
  const detail::Polygon& border_b = border_of(b, met.hole_b);
  const double on_b = std::min(met.length_b(), perimeter(border_b));
  detail::Polygon back = stretch_of(border_b, join.pose.flipped ? met.begin_b : met.begin_b - on_b, on_b);
  if (join.pose.flipped) std::reverse(back.begin(), back.end());
  for (const glm::dvec2& p : back) strip.push_back(join.pose(p));
  return strip;
}

/// Diameter of the largest disc inside a region.
double widest(const detail::Region& region) {
  constexpr double kAccuracy = 0.05;
  double low = 0.0;
  double high = kAccuracy;
  while (!detail::offset(region, -high / 2.0, kAccuracy).empty()) {
    low = high;
    high *= 2.0;
  }
  while (high - low > kAccuracy) {
    const double middle = (low + high) / 2.0;
    (detail::offset(region, -middle / 2.0, kAccuracy).empty() ? high : low) = middle;
  }
  return low;
}

}  // namespace

Seam find_seam(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b, const Planar& pose,
               std::pair<std::uint32_t, std::uint32_t> start, const SeamOptions& options) {
  const SeamWalk walk(a, b, pose, options);
  Seam seam;
  seam.pairs = walk.grow(start, false);
  std::reverse(seam.pairs.begin(), seam.pairs.end());
  seam.pairs.push_back(start);
  const auto after = walk.grow(start, true);
  // Borders that lie along each other all the way round meet themselves at the far end.
  const std::size_t room = a.size() > seam.pairs.size() ? a.size() - seam.pairs.size() : 0;
  seam.pairs.insert(seam.pairs.end(), after.begin(),
                    after.begin() + static_cast<std::ptrdiff_t>(std::min(room, after.size())));
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < seam.pairs.size(); ++k) {
    const auto& [i, j] = seam.pairs[k];
    const double width = k == 0 ? 0.0 : glm::distance(a[seam.pairs[k - 1].first], a[i]);
    const double gap = walk.outside(i, j);
    seam.length += width;
    (gap > 0.0 ? seam.gap_area : seam.overlap_area) += std::abs(gap) * width;
    sum += gap;
    squares += gap * gap;
  }
  const auto count = static_cast<double>(seam.pairs.size());
  seam.mean_gap = sum / count;
  seam.residual = std::sqrt(std::max(0.0, squares / count - seam.mean_gap * seam.mean_gap));
  return seam;
}

double overlap_area(const Outline& a, const Outline& b, const Planar& pose) {
  return detail::area_of(detail::intersect(region_of(a), region_of(moved(b, pose))));
}

JoinAreas join_areas(const Outline& a, const Outline& b, const JoinCandidate& join) {
  detail::Region pieces = region_of(a);
  const detail::Region of_b = region_of(moved(b, join.pose));
  pieces.insert(pieces.end(), of_b.begin(), of_b.end());
  const detail::Region gap = detail::subtract({strip_between(a, b, join)}, pieces);
  return {detail::area_of(gap), overlap_area(a, b, join.pose)};
}

std::vector<Outline> unite(const std::vector<Outline>& placed, double tolerance) {
  detail::Region all;
  for (const Outline& outline : placed) {
    const detail::Region region = region_of(outline);
    all.insert(all.end(), region.begin(), region.end());
  }
  detail::Region closed = detail::unite(all, {});
  if (tolerance > 0.0) {
    const double reach = tolerance / 2.0;
    closed = detail::offset(detail::offset(closed, reach, 0.05 * reach), -reach, 0.05 * reach);
  }
  std::vector<Outline> parts;
  for (const detail::Polygon& polygon : closed) {
    if (polygon.size() >= 3 && signed_area(polygon) > 0.0) parts.push_back({polygon, {}, {}});
  }
  std::sort(parts.begin(), parts.end(),
            [](const Outline& x, const Outline& y) { return signed_area(x.points) > signed_area(y.points); });
  for (const detail::Polygon& polygon : closed) {
    if (polygon.size() < 3 || signed_area(polygon) >= 0.0) continue;
    // The hole's part is the smallest that holds it.
    for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
      if (detail::area_of(
              detail::intersect({part->points}, {detail::Polygon(polygon.rbegin(), polygon.rend())})) <= 0.0)
        continue;
      part->holes.push_back(polygon);
      break;
    }
  }
  return parts;
}

Outline moved(const Outline& outline, const Planar& pose) {
  Outline result = outline;
  const auto move = [&](std::vector<glm::dvec2>& polygon) {
    for (glm::dvec2& p : polygon) p = pose(p);
    if (pose.flipped) std::reverse(polygon.begin(), polygon.end());
  };
  move(result.points);
  for (std::vector<glm::dvec2>& hole : result.holes) move(hole);
  if (pose.flipped) std::reverse(result.colour.begin(), result.colour.end());
  return result;
}

Misfit misfit(const std::vector<Outline>& placed, const Outline& whole) {
  detail::Region united;
  detail::Region twice;
  for (const Outline& outline : placed) {
    const detail::Region region = region_of(outline);
    twice = detail::unite(twice, detail::intersect(united, region));
    united = detail::unite(united, region);
  }
  const detail::Region object = region_of(whole);
  return {widest(twice), widest(detail::subtract(object, united)), widest(detail::subtract(united, object))};
}

}  // namespace rejoin::outline
