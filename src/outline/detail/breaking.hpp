/// Polygons broken in two along rough lines that both sides share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "core/random.hpp"

namespace rejoin::outline::detail {

/// A corner of a polygon, and the straight line on which the edge to the next corner lies: from `begin` to `end` of it,
/// 0..1 of its length.  The two sides of a break have the same line, one of them backwards.
struct Corner {
  glm::dvec2 point{0.0};
  std::uint32_t line = 0;
  double begin = 0.0;
  double end = 1.0;
};
using LinedPolygon = std::vector<Corner>;

struct BreakOptions {
  double step_low = 30.0;    ///< least length of a straight step, pixels
  double step_high = 90.0;   ///< greatest length of a step, pixels
  double spread_rad = 1.05;  ///< how far a step turns off the crack's direction at most
  double roughness =
      0.0;  ///< a step's midpoint is moved sideways by this share of its length (deviation), and so on
  double finest = 1.5;       ///< steps are not halved below this, pixels
  double least_share = 0.3;  ///< of the area on either side of a break, if one of many tries gives it
};

/// Breaks polygons by random walks.  \source naiman 2018, section 3
class Breaker {
 public:
  Breaker(const BreakOptions& options, Random random) : options_(options), random_(random) {}

  /// A polygon whose edges are lines of their own.
  LinedPolygon whole(const std::vector<glm::dvec2>& points);

  /// Starts inside, walks in random steps until one leaves the polygon, and does the same in the opposite direction.
  /// nullopt: no walk of 400 came through without crossing itself.
  std::optional<std::pair<LinedPolygon, LinedPolygon>> split(const LinedPolygon& polygon);

 private:
  using Path = std::vector<glm::dvec2>;
  struct Exit {
    std::size_t edge = 0;
    double share = 0.0;  ///< of the edge
  };
  struct Crack {
    Path path;  ///< from border to border
    Exit first;
    Exit last;
  };
  glm::dvec2 start(const LinedPolygon& polygon);
  void roughen(const glm::dvec2& a, const glm::dvec2& b, Path& path);
  std::optional<Exit> walk(const LinedPolygon& polygon, const glm::dvec2& from, double heading, Path& path);
  std::optional<Crack> crack(const LinedPolygon& polygon);
  std::pair<LinedPolygon, LinedPolygon> cut(LinedPolygon polygon, const Crack& crack);

  BreakOptions options_;
  Random random_;
  std::uint32_t next_line_ = 0;
};

/// Length of the lines that two polygons share, longest index last.
struct SharedLength {
  std::size_t a = 0;
  std::size_t b = 0;
  double length = 0.0;
};

/// All pairs (a < b) with a common boundary.
std::vector<SharedLength> shared_lengths(const std::vector<LinedPolygon>& polygons);

std::vector<glm::dvec2> points_of(const LinedPolygon& polygon);

}  // namespace rejoin::outline::detail
