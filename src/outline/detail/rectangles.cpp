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

constexpr double kRough = 0.01;       // of the perimeter: corners are looked for this roughly
constexpr double kLean = 0.0875;      // cosine of the corners' angles, at most: 5 degrees
constexpr double kCorner = 0.1;       // share of a side at its ends that may be rounded
constexpr double kStraight = 0.8;     // rms distance of a side's points from an even bow, pixels, at most
constexpr double kBow = 0.005;        // of a side's length: how far its middle lies off its ends, at most
constexpr int kFewest = 60;           // points of a side: of smaller outlines nothing is told
constexpr double kLeastOfHole = 0.5;  // area of a hole that a rectangle may come from, share of its own
constexpr std::size_t kNamed = 3;     // of those that are left out

using Corners = std::array<glm::dvec2, 4>;

/// The points beside a side but for its ends: along it from -1 to 1, and their distances from it.
struct Side {
  double length = 0.0;
  std::vector<double> along;
  std::vector<double> off;
};

std::array<Side, 4> sides_of(const std::vector<glm::dvec2>& border, const Corners& corners) {
  std::array<Side, 4> sides;
  for (std::size_t k = 0; k < 4; ++k) sides[k].length = glm::distance(corners[k], corners[(k + 1) % 4]);
  for (const glm::dvec2& p : border) {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t best = 0;
    double best_along = 0.0;
    double best_off = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      const glm::dvec2 side = corners[(k + 1) % 4] - corners[k];
      const double along = glm::dot(p - corners[k], side) / glm::dot(side, side);
      const double distance = glm::distance(p, corners[k] + std::clamp(along, 0.0, 1.0) * side);
      if (distance >= nearest) continue;
      nearest = distance;
      best = k;
      best_along = along;
      best_off = (side.x * (p.y - corners[k].y) - side.y * (p.x - corners[k].x)) / glm::length(side);
    }
    if (best_along < kCorner || best_along > 1.0 - kCorner) continue;
    sides[best].along.push_back(2.0 * best_along - 1.0);
    sides[best].off.push_back(best_off);
  }
  return sides;
}

/// Whether a side is straight, or slightly and evenly bowed as by a lens.
bool is_straight(const Side& side) {
  const auto count = static_cast<int>(side.along.size());
  if (count < kFewest) return false;
  cv::Mat terms(count, 3, CV_64F);
  cv::Mat off(count, 1, CV_64F);
  for (int i = 0; i < count; ++i) {
    const double t = side.along[static_cast<std::size_t>(i)];
    terms.at<double>(i, 0) = 1.0;
    terms.at<double>(i, 1) = t;
    terms.at<double>(i, 2) = t * t;
    off.at<double>(i, 0) = side.off[static_cast<std::size_t>(i)];
  }
  cv::Mat factors;
  cv::solve(terms, off, factors, cv::DECOMP_SVD);
  if (std::abs(factors.at<double>(2)) > kBow * side.length + kStraight) return false;
  return cv::norm(terms * factors - off) < kStraight * std::sqrt(static_cast<double>(count));
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
  return std::ranges::all_of(sides_of(outline.points, corners), is_straight);
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
  if (names.empty() || names.size() + 2 > set.pieces.size()) return;  // no two would be left
  std::erase_if(set.pieces,
                [&](const Piece& piece) { return std::ranges::find(names, piece.name) != names.end(); });
  std::string some;
  for (std::size_t k = 0; k < names.size() && k < kNamed; ++k) some += (k > 0 ? ", " : "") + names[k];
  if (names.size() > kNamed) some += fmt::format(" and {} more", names.size() - kNamed);
  const bool one = names.size() == 1;
  set.notes.push_back(
      fmt::format("{} beside other pieces, as of a ruler, a label or a colour card ({}), {} left out; "
                  "--keep-rectangles keeps them",
                  counted(names.size(), "rectangle"), some, one ? "is" : "are"));
  for (const std::string& name : names)
    set.left_out.push_back(
        {name, "is a rectangle beside other pieces, as of a ruler, a label or a colour card"});
}

}  // namespace rejoin::outline::detail
