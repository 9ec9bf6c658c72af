#include <algorithm>
#include <limits>

#include "outline/contact.hpp"

namespace rejoin::outline {
namespace {

constexpr double kMostCells = 4194304.0;

double squared_distance(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double squared = glm::dot(along, along);
  const double share = squared > 0.0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
  const glm::dvec2 off = p - a - share * along;
  return glm::dot(off, off);
}

}  // namespace

DistanceField::DistanceField(const Outline& outline, double cell, double reach) : cell_(cell), reach_(reach) {
  glm::dvec2 low(std::numeric_limits<double>::max());
  glm::dvec2 high(-std::numeric_limits<double>::max());
  for (const glm::dvec2& p : outline.points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::dvec2 extent = high - low + 2.0 * reach;
  cell_ = std::max(cell_, std::sqrt(extent.x * extent.y / kMostCells));
  origin_ = low - reach;
  columns_ = static_cast<int>(std::ceil(extent.x / cell_)) + 2;
  rows_ = static_cast<int>(std::ceil(extent.y / cell_)) + 2;
  values_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
                 static_cast<float>(reach * reach));
  measure_border(outline.points);
  for (const auto& hole : outline.holes) measure_border(hole);
  for (float& value : values_) value = std::sqrt(value);
  sign_inside(outline);
}

void DistanceField::measure_border(const std::vector<glm::dvec2>& polygon) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2& a = polygon[i];
    const glm::dvec2& b = polygon[(i + 1) % polygon.size()];
    const glm::dvec2 from = (glm::min(a, b) - reach_ - origin_) / cell_;
    const glm::dvec2 to = (glm::max(a, b) + reach_ - origin_) / cell_;
    const int last_row = std::min(rows_ - 1, static_cast<int>(to.y) + 1);
    const int last_column = std::min(columns_ - 1, static_cast<int>(to.x) + 1);
    for (int y = std::max(0, static_cast<int>(from.y)); y <= last_row; ++y) {
      for (int x = std::max(0, static_cast<int>(from.x)); x <= last_column; ++x) {
        float& value = values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                               static_cast<std::size_t>(x)];
        const glm::dvec2 p = origin_ + cell_ * glm::dvec2(x, y);
        value = std::min(value, static_cast<float>(squared_distance(p, a, b)));
      }
    }
  }
}

void DistanceField::sign_inside(const Outline& outline) {
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(rows_));
  const auto add = [&](const std::vector<glm::dvec2>& polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec2 a = (polygon[i] - origin_) / cell_;
      const glm::dvec2 b = (polygon[(i + 1) % polygon.size()] - origin_) / cell_;
      const int first = std::max(0, static_cast<int>(std::ceil(std::min(a.y, b.y))));
      for (int y = first; y < rows_ && y < std::max(a.y, b.y); ++y)
        crossings[static_cast<std::size_t>(y)].push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
    }
  };
  add(outline.points);
  for (const auto& hole : outline.holes) add(hole);
  for (int y = 0; y < rows_; ++y) {
    std::vector<double>& row = crossings[static_cast<std::size_t>(y)];
    std::sort(row.begin(), row.end());
    std::size_t passed = 0;
    for (int x = 0; x < columns_; ++x) {
      while (passed < row.size() && row[passed] < x) ++passed;
      float& value = values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                             static_cast<std::size_t>(x)];
      if (passed % 2 == 0) value = -value;
    }
  }
}

double DistanceField::operator()(const glm::dvec2& point) const {
  const glm::dvec2 at = (point - origin_) / cell_;
  if (!(at.x >= 0.0) || !(at.y >= 0.0) || at.x >= columns_ - 1 || at.y >= rows_ - 1) return -reach_;
  const int x = static_cast<int>(at.x);
  const int y = static_cast<int>(at.y);
  const double u = at.x - x;
  const double v = at.y - y;
  const float* row = &values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                              static_cast<std::size_t>(x)];
  const float* next = row + columns_;
  return (1.0 - v) * ((1.0 - u) * row[0] + u * row[1]) + v * ((1.0 - u) * next[0] + u * next[1]);
}

std::size_t DistanceField::stride(const glm::dvec2& point, double step) const {
  const glm::dvec2 last = origin_ + cell_ * glm::dvec2(columns_ - 1, rows_ - 1);
  const glm::dvec2 off = glm::max(origin_ - point, point - last);
  const double outside = std::max(off.x, off.y);
  return outside > step ? static_cast<std::size_t>(std::ceil(outside / step)) : 1;
}

glm::dvec2 DistanceField::gradient(const glm::dvec2& point) const {
  const DistanceField& field = *this;
  return glm::dvec2(field(point + glm::dvec2(cell_, 0)) - field(point - glm::dvec2(cell_, 0)),
                    field(point + glm::dvec2(0, cell_)) - field(point - glm::dvec2(0, cell_))) /
         (2.0 * cell_);
}

}  // namespace rejoin::outline
