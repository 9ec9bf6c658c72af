#include "outline/turns.hpp"

#include <algorithm>
#include <cmath>

#include "outline/signal.hpp"

namespace rejoin::outline {
namespace {

constexpr double kDegrees = 180.0 / M_PI;

/// Mean of each point with its two neighbours each way: takes the stairs off a border that goes from pixel to pixel, whose
/// length would otherwise depend on its direction.
std::vector<glm::dvec2> without_stairs(const std::vector<glm::dvec2>& points) {
  const std::size_t n = points.size();
  std::vector<glm::dvec2> result(n);
  for (std::size_t i = 0; i < n; ++i) {
    result[i] = (points[(i + n - 2) % n] + 2.0 * points[(i + n - 1) % n] + 3.0 * points[i] +
                 2.0 * points[(i + 1) % n] + points[(i + 2) % n]) /
                9.0;
  }
  return result;
}

/// Every run of straight samples becomes one zero at its middle; a run around the border's end is one run.
void collapse(Turns& turns, double straight_deg) {
  const auto n = static_cast<std::uint32_t>(turns.change_deg.size());
  const auto straight = [&](std::uint32_t i) { return std::abs(turns.change_deg[i % n]) < straight_deg; };
  std::uint32_t begin = 0;
  while (begin < n && straight(begin)) ++begin;
  if (begin == n) {
    turns.values.assign(1, 0.0F);
    turns.index.assign(1, 0);
    return;
  }
  for (std::uint32_t i = begin; i < begin + n;) {
    std::uint32_t end = i;
    while (end < begin + n && straight(end)) ++end;
    const bool run = end > i;
    turns.values.push_back(run ? 0.0F : turns.change_deg[i % n]);
    turns.index.push_back((run ? i + (end - i) / 2 : i) % n);
    i = run ? end : i + 1;
  }
}

}  // namespace

std::vector<double> slopes(const std::vector<glm::dvec2>& points, int window) {
  const auto n = static_cast<std::ptrdiff_t>(points.size());
  const std::ptrdiff_t half = window / 2;
  std::vector<double> result(points.size());
  double before = 0.0;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    // The linear term of a least-squares parabola over a symmetric window is that of the straight line.
    glm::dvec2 along(0.0);
    for (std::ptrdiff_t k = 1; k <= half; ++k)
      along += static_cast<double>(k) * (points[static_cast<std::size_t>((i + k) % n)] -
                                         points[static_cast<std::size_t>((i - k + n) % n)]);
    const double angle = std::atan2(along.y, along.x);
    before += i == 0 ? angle : std::remainder(angle - before, 2.0 * M_PI);
    result[static_cast<std::size_t>(i)] = before;
  }
  return result;
}

Turns turns_of(const std::vector<glm::dvec2>& border, const TurnOptions& options) {
  Turns turns;
  const double own = perimeter(border);
  const auto fine = std::max<std::size_t>(static_cast<std::size_t>(2 * options.window),
                                          static_cast<std::size_t>(std::lround(own / options.step)));
  // Sampled twice: evenly along the border as given, and again when its stairs are off.
  const std::vector<glm::dvec2> smooth = without_stairs(resample(border, fine));
  const std::vector<double> lengths = arc_lengths(smooth);
  const auto count =
      std::max<std::size_t>(static_cast<std::size_t>(2 * options.window),
                            static_cast<std::size_t>(std::lround(lengths.back() / options.step)));
  turns.step = lengths.back() / static_cast<double>(count);
  turns.points.reserve(count);
  turns.places.reserve(count);
  for (const EdgePlace& place : even_places(lengths, count)) {
    turns.points.push_back(point_at(smooth, place));
    turns.places.push_back(own * (static_cast<double>(place.edge) + place.share) / static_cast<double>(fine));
  }
  const std::vector<double> direction = slopes(turns.points, options.window);
  turns.change_deg.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double change = std::remainder(direction[(i + 1) % count] - direction[i], 2.0 * M_PI);
    turns.change_deg.push_back(static_cast<float>(kDegrees * change));
  }
  collapse(turns, options.straight_deg);
  return turns;
}

}  // namespace rejoin::outline
