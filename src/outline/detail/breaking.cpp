#include "outline/detail/breaking.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "outline/outline.hpp"
#include "outline/polygon.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr int kTries = 400;
constexpr int kMostSteps = 5000;

bool boxes_apart(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  const glm::dvec2 low = glm::min(a, b);
  const glm::dvec2 high = glm::max(a, b);
  const glm::dvec2 other_low = glm::min(c, d);
  const glm::dvec2 other_high = glm::max(c, d);
  return high.x < other_low.x || other_high.x < low.x || high.y < other_low.y || other_high.y < low.y;
}

bool crosses_itself(const std::vector<glm::dvec2>& path) {
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    for (std::size_t j = i + 2; j + 1 < path.size(); ++j) {
      if (boxes_apart(path[i], path[i + 1], path[j], path[j + 1])) continue;
      if (meeting(path[i], path[i + 1], path[j], path[j + 1])) return true;
    }
  }
  return false;
}

/// Makes the point at `share` of an edge a corner; returns its index.
std::size_t insert_corner(LinedPolygon& polygon, std::size_t edge, double share) {
  Corner& before = polygon[edge];
  const glm::dvec2& next = polygon[(edge + 1) % polygon.size()].point;
  const double at = before.begin + share * (before.end - before.begin);
  const Corner corner{glm::mix(before.point, next, share), before.line, at, before.end};
  before.end = at;
  polygon.insert(polygon.begin() + static_cast<std::ptrdiff_t>(edge) + 1, corner);
  return edge + 1;
}

/// The corners from index `from` to before index `to`, around the end.
void append_border(const LinedPolygon& polygon, std::size_t from, std::size_t to, LinedPolygon& result) {
  for (std::size_t i = from; i != to; i = (i + 1) % polygon.size()) result.push_back(polygon[i]);
}

}  // namespace

std::vector<glm::dvec2> points_of(const LinedPolygon& polygon) {
  std::vector<glm::dvec2> points;
  points.reserve(polygon.size());
  for (const Corner& corner : polygon) points.push_back(corner.point);
  return points;
}

LinedPolygon Breaker::whole(const std::vector<glm::dvec2>& points) {
  LinedPolygon polygon;
  polygon.reserve(points.size());
  for (const glm::dvec2& point : points) polygon.push_back({point, next_line_++, 0.0, 1.0});
  return polygon;
}

glm::dvec2 Breaker::start(const LinedPolygon& polygon) {
  const std::vector<glm::dvec2> points = points_of(polygon);
  glm::dvec2 low = points[0];
  glm::dvec2 high = low;
  for (const glm::dvec2& point : points) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  glm::dvec2 p = points[0];
  for (int attempt = 0; attempt < kTries; ++attempt) {
    p = {random_.uniform(low.x, high.x), random_.uniform(low.y, high.y)};
    if (contains(points, p)) break;
  }
  return p;
}

void Breaker::roughen(const glm::dvec2& a, const glm::dvec2& b, Path& path) {
  const glm::dvec2 along = b - a;
  const double length = glm::length(along);
  if (options_.roughness > 0.0 && length > 2.0 * options_.finest) {
    const double aside = std::clamp(options_.roughness * random_.normal(), -0.35, 0.35);
    const glm::dvec2 middle = (a + b) / 2.0 + aside * glm::dvec2(-along.y, along.x);
    roughen(a, middle, path);
    roughen(middle, b, path);
  } else {
    path.push_back(b);
  }
}

std::optional<Breaker::Exit> Breaker::walk(const LinedPolygon& polygon, const glm::dvec2& from,
                                           double heading, Path& path) {
  path.assign(1, from);
  for (int step = 0; step < kMostSteps; ++step) {
    const double direction = heading + random_.uniform(-options_.spread_rad, options_.spread_rad);
    const double length = random_.uniform(options_.step_low, options_.step_high);
    const std::size_t first = path.size() - 1;
    roughen(path.back(), path.back() + length * glm::dvec2(std::cos(direction), std::sin(direction)), path);
    for (std::size_t k = first; k + 1 < path.size(); ++k) {
      double least = 2.0;
      Exit exit;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2& c = polygon[i].point;
        const glm::dvec2& d = polygon[(i + 1) % polygon.size()].point;
        if (boxes_apart(path[k], path[k + 1], c, d)) continue;
        const std::optional<glm::dvec2> shares = meeting(path[k], path[k + 1], c, d);
        if (!shares || shares->x >= least) continue;
        least = shares->x;
        exit = {i, shares->y};
      }
      if (least > 1.0) continue;
      path.resize(k + 2);
      path[k + 1] =
          glm::mix(polygon[exit.edge].point, polygon[(exit.edge + 1) % polygon.size()].point, exit.share);
      return exit;
    }
  }
  return std::nullopt;
}

std::optional<Breaker::Crack> Breaker::crack(const LinedPolygon& polygon) {
  const glm::dvec2 from = start(polygon);
  const double heading = random_.uniform(0.0, 2.0 * M_PI);
  Path back;
  Path forth;
  const std::optional<Exit> first = walk(polygon, from, heading + M_PI, back);
  const std::optional<Exit> last = walk(polygon, from, heading, forth);
  if (!first || !last) return std::nullopt;
  if (first->edge == last->edge && first->share == last->share) return std::nullopt;
  Crack result{Path(back.rbegin(), back.rend()), *first, *last};
  result.path.insert(result.path.end(), forth.begin() + 1, forth.end());
  if (result.path.size() < 2 || crosses_itself(result.path)) return std::nullopt;
  return result;
}

std::pair<LinedPolygon, LinedPolygon> Breaker::cut(LinedPolygon polygon, const Crack& crack) {
  Exit last = crack.last;
  std::size_t p = insert_corner(polygon, crack.first.edge, crack.first.share);
  if (last.edge > crack.first.edge) {
    ++last.edge;
  } else if (last.edge == crack.first.edge) {
    const bool behind = last.share > crack.first.share;
    last.share = behind ? (last.share - crack.first.share) / (1.0 - crack.first.share)
                        : last.share / crack.first.share;
    if (behind) ++last.edge;
  }
  const std::size_t q = insert_corner(polygon, last.edge, last.share);
  if (q <= p) ++p;
  LinedPolygon left;
  LinedPolygon right;
  const std::size_t segments = crack.path.size() - 1;
  left.reserve(polygon.size() + segments);
  right.reserve(polygon.size() + segments);
  for (std::size_t i = 0; i < segments; ++i)
    left.push_back({crack.path[i], next_line_ + static_cast<std::uint32_t>(i), 0.0, 1.0});
  append_border(polygon, q, p, left);
  for (std::size_t i = segments; i > 0; --i)
    right.push_back({crack.path[i], next_line_ + static_cast<std::uint32_t>(i - 1), 1.0, 0.0});
  append_border(polygon, p, q, right);
  next_line_ += static_cast<std::uint32_t>(segments);
  return {std::move(left), std::move(right)};
}

std::optional<std::pair<LinedPolygon, LinedPolygon>> Breaker::split(const LinedPolygon& polygon) {
  const double area = signed_area(points_of(polygon));
  std::optional<std::pair<LinedPolygon, LinedPolygon>> best;
  double best_share = 0.0;
  for (int attempt = 0; attempt < kTries && best_share < options_.least_share; ++attempt) {
    const std::optional<Crack> found = crack(polygon);
    if (!found) continue;
    std::pair<LinedPolygon, LinedPolygon> parts = cut(polygon, *found);
    const double share = signed_area(points_of(parts.first)) / area;
    const double least = std::min(share, 1.0 - share);
    if (least <= best_share) continue;
    best_share = least;
    best = std::move(parts);
  }
  return best;
}

std::vector<SharedLength> shared_lengths(const std::vector<LinedPolygon>& polygons) {
  struct Part {
    std::size_t polygon;
    double low, high, length;  // of the line; of the part
  };
  std::map<std::uint32_t, std::vector<Part>> lines;
  for (std::size_t n = 0; n < polygons.size(); ++n) {
    const LinedPolygon& polygon = polygons[n];
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Corner& corner = polygon[i];
      const double length = glm::distance(corner.point, polygon[(i + 1) % polygon.size()].point);
      lines[corner.line].push_back(
          {n, std::min(corner.begin, corner.end), std::max(corner.begin, corner.end), length});
    }
  }
  std::map<std::pair<std::size_t, std::size_t>, double> lengths;
  for (const auto& [line, parts] : lines) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      for (std::size_t j = i + 1; j < parts.size(); ++j) {
        const double both = std::min(parts[i].high, parts[j].high) - std::max(parts[i].low, parts[j].low);
        if (both <= 0.0 || parts[i].polygon == parts[j].polygon) continue;
        const std::pair<std::size_t, std::size_t> pair = std::minmax(parts[i].polygon, parts[j].polygon);
        lengths[pair] += both / (parts[i].high - parts[i].low) * parts[i].length;
      }
    }
  }
  std::vector<SharedLength> result;
  result.reserve(lengths.size());
  for (const auto& [pair, length] : lengths) result.push_back({pair.first, pair.second, length});
  return result;
}

}  // namespace rejoin::outline::detail
