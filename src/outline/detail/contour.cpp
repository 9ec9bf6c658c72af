#include "outline/detail/contour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace rejoin::outline::detail {
namespace {

/// Edges of a cell with corners 0 (x, y), 1 (x + 1, y), 2 (x + 1, y + 1), 3 (x, y + 1): edge e runs from corner e to e + 1.
constexpr std::array<int, 4> kCornerX{0, 1, 1, 0};
constexpr std::array<int, 4> kCornerY{0, 0, 1, 1};
/// The neighbour cell across an edge.
constexpr std::array<int, 4> kAcrossX{0, 1, 0, -1};
constexpr std::array<int, 4> kAcrossY{-1, 0, 1, 0};

class Tracer {
 public:
  Tracer(const cv::Mat& field, float level)
      : field_(field), level_(level), columns_(field.cols + 1), visited_(cells(), 0) {}

  std::vector<std::vector<glm::dvec2>> run(std::size_t least_points) {
    std::vector<std::vector<glm::dvec2>> all;
    for (int y = -1; y < field_.rows; ++y) {
      for (int x = -1; x < field_.cols; ++x) {
        for (int edge = 0; edge < 4; ++edge) {
          if (!enters(x, y, edge) || seen(x, y, edge)) continue;
          std::vector<glm::dvec2> contour = trace(x, y, edge);
          if (contour.size() >= least_points) all.push_back(std::move(contour));
        }
      }
    }
    return all;
  }

 private:
  std::size_t cells() const {
    return static_cast<std::size_t>(columns_) * (static_cast<std::size_t>(field_.rows) + 1);
  }

  /// Height above the level; beyond the border as far below as one pixel inside can be above.
  float height(int x, int y) const {
    if (x < 0 || y < 0 || x >= field_.cols || y >= field_.rows) return -level_;
    return field_.at<float>(y, x) - level_;
  }
  float corner(int x, int y, int c) const { return height(x + kCornerX[c & 3], y + kCornerY[c & 3]); }

  /// Whether a contour comes into the cell through the edge: what is above is on its left with y drawn up, and so is
  /// the edge's first corner.
  bool enters(int x, int y, int edge) const {
    return corner(x, y, edge) > 0.0F && corner(x, y, edge + 1) <= 0.0F;
  }

  bool leaves(int x, int y, int edge) const {
    return corner(x, y, edge) <= 0.0F && corner(x, y, edge + 1) > 0.0F;
  }

  std::uint8_t& marks(int x, int y) {
    return visited_[static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(x + 1)];
  }
  bool seen(int x, int y, int edge) { return (marks(x, y) & (1U << static_cast<unsigned>(edge))) != 0U; }

  glm::dvec2 crossing(int x, int y, int edge) const {
    const double first = corner(x, y, edge);
    const double second = corner(x, y, edge + 1);
    const double share = first / (first - second);
    const int next = (edge + 1) & 3;
    return {x + kCornerX[edge] + share * (kCornerX[next] - kCornerX[edge]),
            y + kCornerY[edge] + share * (kCornerY[next] - kCornerY[edge])};
  }

  /// Where the contour that came in goes out.  In a saddle cell the mean of its corners decides whether the two
  /// high corners are joined.
  int exit(int x, int y, int entry) const {
    const bool saddle = leaves(x, y, (entry + 1) & 3) && leaves(x, y, (entry + 3) & 3);
    if (saddle) {
      const float sum = corner(x, y, 0) + corner(x, y, 1) + corner(x, y, 2) + corner(x, y, 3);
      return sum > 0.0F ? (entry + 1) & 3 : (entry + 3) & 3;
    }
    for (int step = 1; step < 4; ++step) {
      if (leaves(x, y, (entry + step) & 3)) return (entry + step) & 3;
    }
    return entry;
  }

  std::vector<glm::dvec2> trace(int x, int y, int edge) {
    std::vector<glm::dvec2> contour;
    while (!seen(x, y, edge)) {
      marks(x, y) = static_cast<std::uint8_t>(marks(x, y) | (1U << static_cast<unsigned>(edge)));
      const glm::dvec2 point = crossing(x, y, edge);
      if (contour.empty() || point != contour.back()) contour.push_back(point);
      const int out = exit(x, y, edge);
      x += kAcrossX[out];
      y += kAcrossY[out];
      edge = (out + 2) & 3;
    }
    if (contour.size() > 1 && contour.front() == contour.back()) contour.pop_back();
    return contour;
  }

  const cv::Mat& field_;
  float level_;
  int columns_;
  std::vector<std::uint8_t> visited_;
};

}  // namespace

std::vector<std::vector<glm::dvec2>> contours(const cv::Mat& field, float level, std::size_t least_points) {
  return Tracer(field, level).run(least_points);
}

double raster_of(const std::vector<std::vector<glm::dvec2>>& all) {
  constexpr std::size_t kReach = 16;       // points to either side that tell the direction
  constexpr double kAcross = 0.75;         // pixels that both coordinates change by over that reach
  constexpr double kUniform = 1.0 / 12.0;  // mean square of what lies anywhere in a pixel, from its middle
  constexpr double kFewest = 30.0;
  double count = 0.0;
  double squares = 0.0;
  for (const std::vector<glm::dvec2>& contour : all) {
    const std::size_t size = contour.size();
    for (std::size_t i = 0; i < size; ++i) {
      const glm::dvec2 along = contour[(i + kReach) % size] - contour[(i + size - kReach % size) % size];
      if (std::min(std::abs(along.x), std::abs(along.y)) < kAcross) continue;
      // One coordinate is whole, as contours cross the lines between pixels' centres.
      const glm::dvec2 off = contour[i] - glm::floor(contour[i]);
      const double place = std::abs(off.x - 0.5) < std::abs(off.y - 0.5) ? off.x : off.y;
      squares += (place - 0.5) * (place - 0.5);
      count += 1.0;
    }
  }
  return count < kFewest ? 0.0 : std::max(0.0, std::sqrt(kUniform) - std::sqrt(squares / count));
}

}  // namespace rejoin::outline::detail
