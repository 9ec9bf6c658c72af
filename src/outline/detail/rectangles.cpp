#include "outline/detail/rectangles.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <opencv2/imgproc.hpp>

#include "core/words.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr double kRough = 0.01;          // of the perimeter: corners are looked for this roughly
constexpr double kLean = 0.0875;         // cosine of the corners' angles, at most: 5 degrees
constexpr double kCorner = 0.1;          // share of a side at its ends that may be rounded
constexpr double kStraight = 0.0007;     // of the perimeter, rms distance from the sides, at most
constexpr double kStraightPixels = 1.0;  // or that
constexpr double kLeastOfHole = 0.5;     // area of a hole that a rectangle may come from, share of its own
constexpr std::size_t kNamed = 3;        // of those that are left out

using Corners = std::array<glm::dvec2, 4>;

/// Squared distance of a point from the nearest side; negative near its ends.
double squared_distance(const glm::dvec2& p, const Corners& corners) {
  double nearest = std::numeric_limits<double>::infinity();
  bool at_corner = false;
  for (std::size_t k = 0; k < 4; ++k) {
    const glm::dvec2 side = corners[(k + 1) % 4] - corners[k];
    const double along = glm::dot(p - corners[k], side) / glm::dot(side, side);
    const glm::dvec2 off = p - corners[k] - std::clamp(along, 0.0, 1.0) * side;
    if (glm::dot(off, off) >= nearest) continue;
    nearest = glm::dot(off, off);
    at_corner = along < kCorner || along > 1.0 - kCorner;
  }
  return at_corner ? -1.0 : nearest;
}

bool is_square_cornered(const Corners& corners) {
  for (std::size_t k = 0; k < 4; ++k) {
    const glm::dvec2 before = glm::normalize(corners[(k + 3) % 4] - corners[k]);
    const glm::dvec2 after = glm::normalize(corners[(k + 1) % 4] - corners[k]);
    if (std::abs(glm::dot(before, after)) > kLean) return false;
  }
  return true;
}

bool may_fill_a_hole(const Outline& outline, const std::vector<Piece>& pieces) {
  const double area = signed_area(outline.points);
  return std::ranges::any_of(pieces, [&](const Piece& piece) {
    return std::ranges::any_of(piece.outline.holes, [&](const std::vector<glm::dvec2>& hole) {
      return std::abs(signed_area(hole)) > kLeastOfHole * area;
    });
  });
}

}  // namespace

bool is_rectangle(const Outline& outline) {
  std::vector<cv::Point2f> border;
  border.reserve(outline.points.size());
  for (const glm::dvec2& p : outline.points)
    border.emplace_back(static_cast<float>(p.x), static_cast<float>(p.y));
  const double length = perimeter(outline.points);
  std::vector<cv::Point2f> found;
  cv::approxPolyDP(border, found, kRough * length, true);
  if (found.size() != 4) return false;
  Corners corners;
  for (std::size_t k = 0; k < 4; ++k) corners[k] = {found[k].x, found[k].y};
  if (!is_square_cornered(corners)) return false;
  double sum = 0.0;
  std::size_t count = 0;
  for (const glm::dvec2& p : outline.points) {
    const double squared = squared_distance(p, corners);
    if (squared < 0.0) continue;
    sum += squared;
    ++count;
  }
  const double most = std::max(kStraightPixels, kStraight * length);
  return count > 0 && sum < most * most * static_cast<double>(count);
}

void take_out_rectangles(PieceSet& set) {
  std::map<std::string, std::size_t> in_file;
  for (const Piece& piece : set.pieces) ++in_file[piece.path];
  const auto goes = [&](const Piece& piece) {
    return piece.outline.of_pixels && in_file[piece.path] > 1 && is_rectangle(piece.outline) &&
           !may_fill_a_hole(piece.outline, set.pieces);
  };
  std::vector<std::string> names;
  for (const Piece& piece : set.pieces) {
    if (goes(piece)) names.push_back(piece.name);
  }
  if (names.empty() || names.size() == set.pieces.size()) return;
  std::erase_if(set.pieces,
                [&](const Piece& piece) { return std::ranges::find(names, piece.name) != names.end(); });
  std::string some;
  for (std::size_t k = 0; k < names.size() && k < kNamed; ++k) some += (k > 0 ? ", " : "") + names[k];
  if (names.size() > kNamed) some += fmt::format(" and {} more", names.size() - kNamed);
  const bool one = names.size() == 1;
  set.notes.push_back(
      fmt::format("{} beside other pieces, as of a ruler, a label or a colour card ({}), {} left out; save a "
                  "picture of it alone if it is a piece",
                  counted(names.size(), "rectangle"), some, one ? "is" : "are"));
  for (const std::string& name : names)
    set.left_out.push_back(
        {name, "is a rectangle beside other pieces, as of a ruler, a label or a colour card"});
}

}  // namespace rejoin::outline::detail
