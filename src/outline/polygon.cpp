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
constexpr std::size_t kLeastCorners = 4;
/// With more loops, and more than one at every fourth point, the file is no outline.
constexpr std::size_t kMostLoops = 500;
constexpr std::size_t kPointsALoop = 4;

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

/// A closed polygon whose loops are cut off.  Edges keep their numbers; those of a loop are taken out.
class LoopsCut {
 public:
  explicit LoopsCut(const Polygon& polygon)
      : grid_(polygon),
        begins_(polygon),
        ends_(polygon),
        is_left_(polygon.size(), true),
        left_(polygon.size()) {
    std::rotate(ends_.begin(), ends_.begin() + 1, ends_.end());
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      after_.push_back((i + 1) % polygon.size());
      before_.push_back((i + polygon.size() - 1) % polygon.size());
      doubled_area_ += doubled_area(begins_[i], ends_[i]);
    }
  }

  /// Edges that are left.
  std::size_t size() const { return left_; }

  /// The next edge that meets a later one, and the first of those that it meets.  Cutting makes no edge longer, so those before it are
  /// looked at again in the end alone: a cut's rounding may have turned an edge that lay along another.
  std::optional<Crossing> next_crossing() {
    for (;; ++at_) {
      if (at_ == begins_.size()) {
        if (!is_cut_) return std::nullopt;
        is_cut_ = false;
        at_ = 0;
      }
      if (!is_left_[at_]) continue;
      std::optional<Crossing> found;
      grid_.visit_later(at_, [&](std::size_t j) {
        if (!is_left_[j] || after_[at_] == j || after_[j] == at_ || (found && found->second <= j)) return;
        const auto shares = meeting(begins_[at_], ends_[at_], begins_[j], ends_[j]);
        if (shares) found = Crossing{at_, j, begins_[at_] + shares->x * (ends_[at_] - begins_[at_])};
      });
      if (found) return found;
    }
  }

  /// Cuts off the smaller of the two loops at a crossing.
  /// \return its area, as a share of the other one's
  double cut(const Crossing& at) {
    const auto& [i, j, point] = at;
    // Both loops are followed in step until the shorter one ends.
    double inner = doubled_area(point, ends_[i]) + doubled_area(begins_[j], point);
    double outer = doubled_area(point, ends_[j]) + doubled_area(begins_[i], point);
    std::size_t in = after_[i];
    std::size_t out = after_[j];
    for (; in != j && out != i; in = after_[in], out = after_[out]) {
      inner += doubled_area(begins_[in], ends_[in]);
      outer += doubled_area(begins_[out], ends_[out]);
    }
    (in == j ? outer : inner) = doubled_area_ - (in == j ? inner : outer);
    const bool inner_smaller = std::abs(inner) < std::abs(outer);
    const std::size_t first =
        inner_smaller ? i : j;  // the loop lies between the end of this and the begin of the other
    const std::size_t last = inner_smaller ? j : i;
    while (after_[first] != last) take_out(after_[first]);
    ends_[first] = point;
    begins_[last] = point;
    is_cut_ = true;
    doubled_area_ = inner_smaller ? outer : inner;
    for (const std::size_t edge : {first, last})
      if (begins_[edge] == ends_[edge]) take_out(edge);
    return std::min(std::abs(inner), std::abs(outer)) / std::max(std::abs(inner), std::abs(outer));
  }

  /// What is left, from the first point that is.
  Polygon polygon() const {
    Polygon result;
    for (std::size_t i = 0; i < begins_.size(); ++i)
      if (is_left_[i]) result.push_back(begins_[i]);
    return without_repeats(result);
  }

 private:
  /// What an edge adds to the doubled area.
  double doubled_area(const glm::dvec2& from, const glm::dvec2& to) const {
    return cross(from - begins_.front(), to - begins_.front());
  }

  void take_out(std::size_t edge) {
    is_left_[edge] = false;
    --left_;
    after_[before_[edge]] = after_[edge];
    before_[after_[edge]] = before_[edge];
  }

  EdgeGrid grid_;
  Polygon begins_;  ///< of every edge
  Polygon ends_;
  std::vector<bool> is_left_;
  std::vector<std::size_t> after_;  ///< the next edge that is left
  std::vector<std::size_t> before_;
  double doubled_area_ = 0.0;
  std::size_t left_;
  std::size_t at_ = 0;
  bool is_cut_ = false;  ///< since at_ was 0
};

/// \param notes  gets a sentence if loops were cut off
/// \throws InputError  one is too large, or there are too many
Polygon without_loops(const Polygon& polygon, const std::string& subject, std::vector<std::string>& notes) {
  const std::size_t most = std::max(kMostLoops, polygon.size() / kPointsALoop);
  LoopsCut left(polygon);
  std::size_t loops = 0;
  while (left.size() >= kLeastCorners) {
    const auto crossing = left.next_crossing();
    if (!crossing) break;
    if (left.cut(*crossing) > kMostLoopArea) {
      throw InputError(
          subject,
          fmt::format("the outline crosses itself: edge {} meets edge {} near ({:.6g}, {:.6g})",
                      crossing->first + 1, crossing->second + 1, crossing->point.x, crossing->point.y),
          "draw it without crossings");
    }
    if (++loops > most)
      throw InputError(subject, "the outline crosses itself everywhere", "draw it without crossings");
  }
  if (loops == 0) return polygon;
  notes.push_back(
      fmt::format("{}: the outline crosses itself; {} cut off", subject, counted(loops, "small loop")));
  return left.polygon();
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
  if (polygon.size() < kLeastCorners) return std::nullopt;
  return LoopsCut(polygon).next_crossing();
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
  if (polygon.size() >= kLeastCorners) polygon = without_loops(polygon, subject, notes);
  if (polygon.size() < kLeastCorners) {
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
