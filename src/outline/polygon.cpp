#include "outline/polygon.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/words.hpp"
#include "outline/outline.hpp"

namespace rejoin::outline {
namespace {

using Polygon = std::vector<glm::dvec2>;

/// A loop with more than this share of the area is no slip of the pen.
constexpr double kMostLoopArea = 0.02;
constexpr std::size_t kLeastPoints = 4;
/// With more loops the file is no outline.
constexpr std::size_t kMostLoops = 500;

/// Edges sorted into square cells, so that only near ones are compared.
class EdgeGrid {
 public:
  explicit EdgeGrid(const Polygon& polygon) : polygon_(polygon) {
    glm::dvec2 high(-std::numeric_limits<double>::infinity());
    low_ = -high;
    for (const glm::dvec2& p : polygon) {
      low_ = glm::min(low_, p);
      high = glm::max(high, p);
    }
    const double edges = static_cast<double>(polygon.size());
    const glm::dvec2 size = high - low_;
    cell_ = std::max({perimeter(polygon) / edges, std::max(size.x, size.y) / kMostCells, 1e-300});
    columns_ = static_cast<std::size_t>(size.x / cell_) + 1;
    rows_ = static_cast<std::size_t>(size.y / cell_) + 1;
    fill();
  }

  /// Calls visit(edge) for the edges that share a cell with edge i and come later in the polygon.
  template <typename Visit>
  void visit_later(std::size_t i, const Visit& visit) const {
    for_cells(i, [&](std::size_t cell) {
      for (std::size_t k = starts_[cell]; k < starts_[cell + 1]; ++k) {
        if (edges_[k] > i) visit(edges_[k]);
      }
    });
  }

 private:
  static constexpr double kMostCells = 1024.0;  ///< along the longer side

  template <typename Visit>
  void for_cells(std::size_t i, const Visit& visit) const {
    const glm::dvec2 a = polygon_[i];
    const glm::dvec2 b = polygon_[(i + 1) % polygon_.size()];
    const glm::dvec2 low = (glm::min(a, b) - low_) / cell_;
    const glm::dvec2 high = (glm::max(a, b) - low_) / cell_;
    const std::size_t last_row = std::min(static_cast<std::size_t>(high.y), rows_ - 1);
    const std::size_t last_column = std::min(static_cast<std::size_t>(high.x), columns_ - 1);
    for (auto row = static_cast<std::size_t>(low.y); row <= last_row; ++row) {
      for (auto column = static_cast<std::size_t>(low.x); column <= last_column; ++column)
        visit(row * columns_ + column);
    }
  }

  void fill() {
    std::vector<std::size_t> counts(columns_ * rows_ + 1, 0);
    for (std::size_t i = 0; i < polygon_.size(); ++i)
      for_cells(i, [&](std::size_t cell) { ++counts[cell + 1]; });
    for (std::size_t c = 1; c < counts.size(); ++c) counts[c] += counts[c - 1];
    starts_ = counts;
    edges_.resize(starts_.back());
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      for_cells(i, [&](std::size_t cell) { edges_[counts[cell]++] = i; });
    }
  }

  const Polygon& polygon_;
  glm::dvec2 low_{0.0};
  double cell_ = 1.0;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  std::vector<std::size_t> starts_;
  std::vector<std::size_t> edges_;
};

Polygon without_repeats(const Polygon& polygon) {
  Polygon result;
  result.reserve(polygon.size());
  for (const glm::dvec2& p : polygon) {
    if (result.empty() || p != result.back()) result.push_back(p);
  }
  while (result.size() > 1 && result.front() == result.back()) result.pop_back();
  return result;
}

/// The polygon without the smaller of the two loops at the crossing.
Polygon cut_loop(const Polygon& polygon, const Crossing& at, const std::string& subject) {
  const auto begin = polygon.begin();
  Polygon inner(begin + static_cast<std::ptrdiff_t>(at.first) + 1,
                begin + static_cast<std::ptrdiff_t>(at.second) + 1);
  inner.push_back(at.point);
  Polygon outer(begin, begin + static_cast<std::ptrdiff_t>(at.first) + 1);
  outer.push_back(at.point);
  outer.insert(outer.end(), begin + static_cast<std::ptrdiff_t>(at.second) + 1, polygon.end());
  const bool inner_smaller = std::abs(signed_area(inner)) < std::abs(signed_area(outer));
  const Polygon& loop = inner_smaller ? inner : outer;
  Polygon& rest = inner_smaller ? outer : inner;
  if (std::abs(signed_area(loop)) > kMostLoopArea * std::abs(signed_area(rest))) {
    throw InputError(subject,
                     fmt::format("the outline crosses itself: edge {} meets edge {} near ({:.6g}, {:.6g})",
                                 at.first + 1, at.second + 1, at.point.x, at.point.y),
                     "draw it without crossings");
  }
  return without_repeats(rest);
}

}  // namespace

void require_usual_points(const Polygon& polygon, const std::string& subject) {
  constexpr double kLargest = 1e12;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2& p = polygon[i];
    if (std::abs(p.x) <= kLargest && std::abs(p.y) <= kLargest) continue;
    throw InputError(
        subject,
        fmt::format("point {} ({:g}, {:g}) is not within {:g} of the origin", i + 1, p.x, p.y, kLargest),
        "take it out");
  }
}

bool contains(const Polygon& polygon, const glm::dvec2& point) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const glm::dvec2& a = polygon[i];
    const glm::dvec2& b = polygon[j];
    if ((a.y > point.y) != (b.y > point.y) && point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x)
      inside = !inside;
  }
  return inside;
}

glm::dvec2 inner_point(const Polygon& polygon) {
  return inner_point(std::vector<Polygon>{polygon});
}

glm::dvec2 inner_point(const std::vector<Polygon>& rings) {
  const Polygon& polygon = rings[0];
  const auto [lowest, highest] = std::ranges::minmax(polygon, {}, [](const glm::dvec2& p) { return p.y; });
  const double y = 0.5 * (lowest.y + highest.y);
  std::vector<double> crossings;
  for (const Polygon& ring : rings) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const glm::dvec2& a = ring[i];
      const glm::dvec2& b = ring[j];
      if ((a.y > y) != (b.y > y)) crossings.push_back((b.x - a.x) * (y - a.y) / (b.y - a.y) + a.x);
    }
  }
  std::ranges::sort(crossings);
  glm::dvec2 widest = polygon[0];
  double width = 0.0;
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    if (crossings[i + 1] - crossings[i] <= width) continue;
    width = crossings[i + 1] - crossings[i];
    widest = {0.5 * (crossings[i] + crossings[i + 1]), y};
  }
  return widest;
}

std::optional<glm::dvec2> meeting(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                                  const glm::dvec2& d) {
  const glm::dvec2 ab = b - a;
  const glm::dvec2 cd = d - c;
  const double denominator = cross(ab, cd);
  if (denominator == 0.0) return std::nullopt;
  const glm::dvec2 shares(cross(c - a, cd) / denominator, cross(c - a, ab) / denominator);
  if (shares.x < 0.0 || shares.x > 1.0 || shares.y < 0.0 || shares.y > 1.0) return std::nullopt;
  return shares;
}

std::optional<Crossing> find_crossing(const Polygon& polygon) {
  const std::size_t count = polygon.size();
  if (count < 4) return std::nullopt;
  const EdgeGrid grid(polygon);
  for (std::size_t i = 0; i + 2 < count; ++i) {
    std::optional<Crossing> found;
    grid.visit_later(i, [&](std::size_t j) {
      if (j < i + 2 || (i == 0 && j + 1 == count)) return;
      if (found && found->second <= j) return;
      const auto shares = meeting(polygon[i], polygon[i + 1], polygon[j], polygon[(j + 1) % count]);
      if (shares) found = Crossing{i, j, polygon[i] + shares->x * (polygon[i + 1] - polygon[i])};
    });
    if (found) return found;
  }
  return std::nullopt;
}

std::optional<double> open_ends(const Polygon& line) {
  constexpr double kLonger = 4.0;
  constexpr double kLeastShare = 0.05;
  constexpr std::size_t kLeastOfALine = 12;  // fewer are corners, any of which may be far from the next
  if (line.size() < kLeastOfALine) return std::nullopt;
  double length = 0.0;
  double longest = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double edge = glm::distance(line[i], line[i + 1]);
    length += edge;
    longest = std::max(longest, edge);
  }
  const double apart = glm::distance(line.front(), line.back());
  if (apart <= kLonger * longest || apart <= kLeastShare * length) return std::nullopt;
  return apart;
}

std::optional<std::string> doubt_ends(const Polygon& line) {
  const auto apart = open_ends(line);
  if (!apart) return std::nullopt;
  return fmt::format(
      "the outline is open, and its ends, {:.4g} apart, are joined by a straight edge; if border is missing "
      "there, draw it, and else close it",
      *apart);
}

Polygon mend_polygon(Polygon polygon, const std::string& subject, std::vector<std::string>& notes) {
  require_usual_points(polygon, subject);
  polygon = without_repeats(polygon);
  std::size_t loops = 0;
  while (polygon.size() >= kLeastPoints) {
    const auto crossing = find_crossing(polygon);
    if (!crossing) break;
    polygon = cut_loop(polygon, *crossing, subject);
    if (++loops > kMostLoops)
      throw InputError(subject, "the outline crosses itself everywhere", "draw it without crossings");
  }
  if (loops > 0)
    notes.push_back(
        fmt::format("{}: the outline crosses itself; {} cut off", subject, counted(loops, "small loop")));
  if (polygon.size() < kLeastPoints) {
    throw InputError(subject,
                     fmt::format("an outline of {} points says nothing of where it broke", polygon.size()),
                     "give the border with at least 4 points, better hundreds");
  }
  const double area = signed_area(polygon);
  if (area == 0.0) throw InputError(subject, "the outline encloses no area", "give a closed border");
  if (area < 0.0)
    std::reverse(polygon.begin() + 1, polygon.end());  // places are told from the first point on
  return polygon;
}

}  // namespace rejoin::outline
