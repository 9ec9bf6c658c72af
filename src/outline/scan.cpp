#include "outline/scan.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "outline/outline.hpp"

namespace rejoin::outline {
namespace {

/// Lines looked at in each row of pixels; along a line the coverage is exact.
constexpr int kLinesPerRow = 8;

/// Where a horizontal line crosses a closed polygon, ascending.
class Crossings {
 public:
  explicit Crossings(const std::vector<glm::dvec2>& border) : border_(border) {
    order_.resize(border.size());
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = i;
    std::sort(order_.begin(), order_.end(), [this](std::size_t a, std::size_t b) { return low(a) < low(b); });
  }

  /// \pre y is not below that of the call before
  const std::vector<double>& at(double y) {
    while (next_ < order_.size() && low(order_[next_]) <= y) active_.push_back(order_[next_++]);
    active_.erase(std::remove_if(active_.begin(), active_.end(), [&](std::size_t i) { return high(i) <= y; }),
                  active_.end());
    places_.clear();
    for (const std::size_t i : active_) {
      const glm::dvec2& a = border_[i];
      const glm::dvec2& b = end(i);
      places_.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    std::sort(places_.begin(), places_.end());
    return places_;
  }

 private:
  const glm::dvec2& end(std::size_t i) const { return border_[(i + 1) % border_.size()]; }
  double low(std::size_t i) const { return std::min(border_[i].y, end(i).y); }
  double high(std::size_t i) const { return std::max(border_[i].y, end(i).y); }

  const std::vector<glm::dvec2>& border_;
  std::vector<std::size_t> order_;
  std::vector<std::size_t> active_;
  std::vector<double> places_;
  std::size_t next_ = 0;
};

/// Adds the pixels of a row between two places, the last ones in part.
void add_span(float* row, int width, double begin, double end, float weight) {
  begin = std::max(begin, -0.5);
  end = std::min(end, width - 0.5);
  if (end <= begin) return;
  const int first = static_cast<int>(std::lround(begin));
  const int last = std::min(width - 1, static_cast<int>(std::lround(end)));
  for (int x = first; x <= last; ++x) {
    const double share = std::min(end, x + 0.5) - std::max(begin, x - 0.5);
    row[x] += weight * static_cast<float>(std::max(0.0, share));
  }
}

/// Pixels whose centres lie inside; `low` is the centre of the first.
cv::Mat mask_of(const std::vector<glm::dvec2>& border, const glm::dvec2& low, int width, int height) {
  cv::Mat mask = cv::Mat::zeros(height, width, CV_8U);
  Crossings crossings(border);
  for (int y = 0; y < height; ++y) {
    const std::vector<double>& places = crossings.at(low.y + y);
    for (std::size_t i = 0; i + 1 < places.size(); i += 2) {
      const int first = std::max(0, static_cast<int>(std::ceil(places[i] - low.x)));
      const int last = std::min(width - 1, static_cast<int>(std::floor(places[i + 1] - low.x)));
      if (first <= last) mask(cv::Rect(first, y, last - first + 1, 1)).setTo(255);
    }
  }
  return mask;
}

}  // namespace

std::vector<glm::dvec2> sample_border(const std::vector<glm::dvec2>& border, double noise, Random& random) {
  const std::vector<double> lengths = arc_lengths(border);
  const auto count = std::max<std::size_t>(8, static_cast<std::size_t>(lengths.back()));
  const double begin = random.uniform(0.0, lengths.back());
  std::vector<glm::dvec2> points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = begin + lengths.back() * static_cast<double>(i) / static_cast<double>(count);
    const double dx = noise * random.normal();
    const double dy = noise * random.normal();
    points.push_back(point_at(border, lengths, at) + glm::dvec2(dx, dy));
  }
  return points;
}

std::vector<glm::dvec2> edge_pixels(const std::vector<glm::dvec2>& border) {
  if (border.empty()) return {};
  glm::dvec2 low = border[0];
  glm::dvec2 high = border[0];
  for (const glm::dvec2& p : border) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  low = glm::floor(low) - 1.0;
  const glm::dvec2 size = glm::ceil(high) - low + 2.0;
  const cv::Mat mask = mask_of(border, low, static_cast<int>(size.x), static_cast<int>(size.y));
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  std::vector<glm::dvec2> best;
  for (const std::vector<cv::Point>& contour : contours) {
    if (contour.size() <= best.size()) continue;
    best.clear();
    for (const cv::Point& p : contour) best.push_back(low + glm::dvec2(p.x, p.y));
  }
  if (signed_area(best) < 0.0) std::reverse(best.begin(), best.end());
  return best;
}

std::vector<float> pixel_coverage(const std::vector<glm::dvec2>& border, int width, int height) {
  std::vector<float> coverage(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0F);
  Crossings crossings(border);
  for (int y = 0; y < height; ++y) {
    float* row = coverage.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    for (int line = 0; line < kLinesPerRow; ++line) {
      const std::vector<double>& places = crossings.at(y - 0.5 + (line + 0.5) / kLinesPerRow);
      for (std::size_t i = 0; i + 1 < places.size(); i += 2)
        add_span(row, width, places[i], places[i + 1], 1.0F / kLinesPerRow);
    }
  }
  return coverage;
}

}  // namespace rejoin::outline
