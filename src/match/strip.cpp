#include "match/strip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/angle.hpp"
#include "core/median.hpp"

namespace rejoin::match {
namespace {

constexpr double kElongated = 3.0;  // length over width from which a facet is a strip
constexpr double kStretch =
    0.5;  // of the shorter strip: where less than that joins, its course does not count
constexpr std::size_t kStretches = 32;
constexpr std::size_t kPointsAsked = 1000;
constexpr std::size_t kDiscs = 32;
constexpr double kDisc = 1.5;  // radius of those that tell the width, widths
constexpr int kWidthRounds = 4;
constexpr double kAstray = 0.25;  // radians, by which stretches that join may be turned
constexpr double kApart = 0.5;    // of the mean width, by which their bends may part at their ends

constexpr double kHole = 0.25;  // of the mean width: radius about the middle in which a ring has nothing
constexpr std::size_t kSectors = 12;  // around the middle of a break that runs all around, as a tube's does

/// The course of a stretch: v = bow * u^2 in axes turned by `direction`.
struct Course {
  double direction = 0;  ///< radians, against x; its opposite is the same
  double bow = 0;
};

bool is_strip(const FacetPatch& patch) {
  return patch.length > kElongated * patch.across;
}

/// Whether a facet surrounds its middle without lying there: a ring has stretches of every direction, and others on the far side of a narrow one.
bool runs_around(const FacetPatch& patch) {
  glm::dvec2 middle(0.0);
  for (const glm::vec3& point : patch.points)
    middle += glm::dvec2(point) / static_cast<double>(patch.points.size());
  std::array<bool, kSectors> seen{};
  for (const glm::vec3& point : patch.points) {
    const glm::dvec2 from = glm::dvec2(point) - middle;
    if (glm::length(from) < kHole * patch.across) return false;
    const double part = std::atan2(from.y, from.x) / kTurn + 0.5;
    seen[std::min(kSectors - 1, static_cast<std::size_t>(part * kSectors))] = true;
  }
  return std::ranges::all_of(seen, std::identity());
}

/// The points of a stretch, relative to their mean.
std::vector<glm::dvec2> stretch_at(const std::vector<glm::vec3>& points, const glm::vec2& middle,
                                   double radius) {
  const auto reach = static_cast<float>(radius * radius);
  std::vector<glm::dvec2> near;
  glm::dvec2 sum(0.0);
  for (const glm::vec3& point : points) {
    const glm::vec2 from = glm::vec2(point) - middle;
    if (glm::dot(from, from) > reach) continue;
    near.emplace_back(from);
    sum += near.back();
  }
  for (glm::dvec2& p : near) p -= sum / static_cast<double>(near.size());
  return near;
}

Course course_of(const std::vector<glm::dvec2>& stretch) {
  double uu = 0.0;
  double uv = 0.0;
  double vv = 0.0;
  for (const glm::dvec2& p : stretch) {
    uu += p.x * p.x;
    uv += p.x * p.y;
    vv += p.y * p.y;
  }
  const double direction = 0.5 * std::atan2(2.0 * uv, uu - vv);
  const glm::dvec2 along(std::cos(direction), std::sin(direction));
  double squares = 0.0;
  double fourths = 0.0;
  double bent = 0.0;
  for (const glm::dvec2& p : stretch) {
    const double u = glm::dot(p, along);
    squares += u * u;
    fourths += u * u * u * u;
    bent += u * u * (along.x * p.y - along.y * p.x);
  }
  const double variance = fourths - squares * squares / static_cast<double>(stretch.size());
  return {direction, variance > 0.0 ? bent / variance : 0.0};
}

std::vector<Course> courses(const FacetPatch& strip, double length) {
  std::vector<Course> result;
  const std::size_t count = std::min(kStretches, strip.points.size());
  for (std::size_t k = 0; k < count; ++k) {
    const glm::vec2 middle(strip.points[k * strip.points.size() / count]);
    result.push_back(course_of(stretch_at(strip.points, middle, 0.5 * length)));
  }
  return result;
}

}  // namespace

void measure_across(FacetPatch& patch) {
  patch.across = patch.area / std::max(patch.length, 1e-30);
  if (patch.points.empty() || (!is_strip(patch) && !runs_around(patch))) return;
  const std::size_t step = patch.points.size() / kPointsAsked + 1;
  std::vector<glm::vec2> points;
  for (std::size_t k = 0; k < patch.points.size(); k += step) points.emplace_back(patch.points[k]);
  const double a_point = patch.area / static_cast<double>(points.size());
  const std::size_t discs = std::min(kDiscs, points.size());
  const double straight = patch.across;
  std::vector<double> widths(discs);
  for (int round = 0; round < kWidthRounds; ++round) {
    const double reach = kDisc * patch.across;
    const auto squared = static_cast<float>(reach * reach);
    for (std::size_t k = 0; k < discs; ++k) {
      const glm::vec2 middle = points[k * points.size() / discs];
      const auto near = std::ranges::count_if(points, [&](const glm::vec2& point) {
        const glm::vec2 from = point - middle;
        return glm::dot(from, from) < squared;
      });
      widths[k] = a_point * static_cast<double>(near) / (2.0 * reach);
    }
    patch.across = std::min(straight, median(widths));
  }
}

bool are_strips(const FacetPatch& a, const FacetPatch& b) {
  return is_strip(a) && is_strip(b);
}

std::vector<double> turns_along(const FacetPatch& a, const FacetPatch& b, double step) {
  const double wide = std::max(a.across, b.across);
  const double length = std::max(kStretch * std::min(a.length, b.length), kElongated * wide);
  const double alike = kApart * wide / (0.25 * length * length);
  const int count = static_cast<int>(std::ceil(kTurn / step));
  const double turn = kTurn / count;
  const bool any = runs_around(a) || runs_around(b);
  std::vector<char> wanted(static_cast<std::size_t>(count), any ? 1 : 0);
  const std::vector<Course> of_b = courses(b, length);
  for (const Course& x : courses(a, length)) {
    for (const Course& y : of_b) {
      for (const bool about : {false, true}) {
        if (std::abs(x.bow - (about ? -y.bow : y.bow)) > alike) continue;
        const double middle = x.direction + y.direction + (about ? 0.5 * kTurn : 0.0);
        const int last = static_cast<int>(std::floor((middle + kAstray) / turn));
        for (int k = static_cast<int>(std::ceil((middle - kAstray) / turn)); k <= last; ++k)
          wanted[static_cast<std::size_t>(((k % count) + count) % count)] = 1;
      }
    }
  }
  std::vector<double> turns;
  for (int k = 0; k < count; ++k) {
    if (wanted[static_cast<std::size_t>(k)] != 0) turns.push_back(turn * k);
  }
  return turns;
}

}  // namespace rejoin::match
