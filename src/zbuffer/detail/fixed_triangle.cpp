#include "zbuffer/detail/fixed_triangle.hpp"

#include <algorithm>
#include <utility>

namespace rejoin::zbuffer::detail {
namespace {

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  const std::int64_t quotient = a / b;
  return quotient - ((a % b != 0 && (a < 0) != (b < 0)) ? 1 : 0);
}

/// Pixels i with first <= i <= last.
struct Span {
  std::int64_t first;
  std::int64_t last;
};

/// Narrows a row's span to the pixels whose centre lies on the inner side of the edge.
void clip(const Edge& edge, std::int64_t py, Span& span) {
  const std::int64_t start = edge.at(centre_of(0), py) - edge.least();  // covered: start - dy * 1024 * i >= 0
  const std::int64_t step = -edge.dy * kSubpixels;
  if (step == 0) {
    if (start < 0) span.last = span.first - 1;
  } else if (step > 0) {
    span.first = std::max(span.first, -floor_div(start, step));
  } else {
    span.last = std::min(span.last, floor_div(start, -step));
  }
}

bool drawable(const glm::vec3& p) {
  return std::abs(p.x) < kReach && std::abs(p.y) < kReach && std::isfinite(p.z);
}

/// First pixel whose centre is at or above the grid coordinate, and last one at or below it.
std::int64_t first_centre(std::int64_t low) {
  return -floor_div(kSubpixels / 2 - low, kSubpixels);
}
std::int64_t last_centre(std::int64_t high) {
  return floor_div(high - kSubpixels / 2, kSubpixels);
}

}  // namespace

std::optional<FixedTriangle> snap(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  if (!drawable(a) || !drawable(b) || !drawable(c)) return std::nullopt;
  FixedTriangle t{};
  const glm::vec3 corners[3] = {a, b, c};
  for (int k = 0; k < 3; ++k) {
    t.x[k] = std::lrint(corners[k].x * static_cast<float>(kSubpixels));
    t.y[k] = std::lrint(corners[k].y * static_cast<float>(kSubpixels));
    t.z[k] = corners[k].z;
  }
  if (!orient(t)) return std::nullopt;
  return t;
}

bool orient(FixedTriangle& t) {
  t.area2 = (t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - (t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
  if (t.area2 < 0) {
    std::swap(t.x[1], t.x[2]);
    std::swap(t.y[1], t.y[2]);
    std::swap(t.z[1], t.z[2]);
    t.area2 = -t.area2;
  }
  return t.area2 != 0;
}

void fill(const FixedTriangle& t, const Canvas& canvas) {
  const auto [low_x, high_x] = std::minmax({t.x[0], t.x[1], t.x[2]});
  const auto [low_y, high_y] = std::minmax({t.y[0], t.y[1], t.y[2]});
  const Span columns{std::max<std::int64_t>(0, first_centre(low_x)),
                     std::min<std::int64_t>(canvas.width - 1, last_centre(high_x))};
  const Span rows{std::max<std::int64_t>(0, first_centre(low_y)),
                  std::min<std::int64_t>(canvas.height - 1, last_centre(high_y))};
  const Edge edges[3] = {t.edge(0), t.edge(1), t.edge(2)};
  const double rise1 = (static_cast<double>(t.z[1]) - t.z[0]) / static_cast<double>(t.area2);
  const double rise2 = (static_cast<double>(t.z[2]) - t.z[0]) / static_cast<double>(t.area2);
  const double step =
      -kSubpixels * (static_cast<double>(edges[1].dy) * rise1 + static_cast<double>(edges[2].dy) * rise2);
  for (std::int64_t j = rows.first; j <= rows.last; ++j) {
    const std::int64_t py = centre_of(j);
    Span span = columns;
    for (const Edge& edge : edges) clip(edge, py, span);
    if (span.first > span.last) continue;
    const std::int64_t px = centre_of(span.first);
    const double start = t.z[0] + static_cast<double>(edges[1].at(px, py)) * rise1 +
                         static_cast<double>(edges[2].at(px, py)) * rise2;
    float* pixel = canvas.depth + j * canvas.width + span.first;
    const int count = static_cast<int>(span.last - span.first) + 1;
    for (int i = 0; i < count; ++i) pixel[i] = nearest(pixel[i], static_cast<float>(start + step * i));
  }
}

}  // namespace rejoin::zbuffer::detail
