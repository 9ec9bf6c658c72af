#include "outline/detail/clip.hpp"

#include <algorithm>
#include <clipper.hpp>
#include <cmath>

#include "outline/outline.hpp"

namespace rejoin::outline::detail {
namespace {

/// Clipper counts in whole numbers; below 2^30 it needs no 128-bit products.
constexpr double kMostInteger = 500000000.0;

struct Grid {
  glm::dvec2 origin{0.0};
  double scale = 1.0;
};

/// A grid for everything within `margin` of both regions.
Grid grid_of(const Region& a, const Region& b, double margin) {
  glm::dvec2 low(0.0);
  glm::dvec2 high(0.0);
  bool first = true;
  for (const Region* region : {&a, &b}) {
    for (const Polygon& polygon : *region) {
      for (const glm::dvec2& p : polygon) {
        low = first ? p : glm::min(low, p);
        high = first ? p : glm::max(high, p);
        first = false;
      }
    }
  }
  const double extent = std::max({high.x - low.x, high.y - low.y, margin, 1e-300}) + 2.0 * margin;
  return {(low + high) / 2.0, kMostInteger / extent};
}

ClipperLib::Paths to_paths(const Region& region, const Grid& grid) {
  ClipperLib::Paths paths;
  paths.reserve(region.size());
  for (const Polygon& polygon : region) {
    ClipperLib::Path& path = paths.emplace_back();
    path.reserve(polygon.size());
    for (const glm::dvec2& p : polygon) {
      const glm::dvec2 at = (p - grid.origin) * grid.scale;
      path.emplace_back(std::llround(at.x), std::llround(at.y));
    }
  }
  return paths;
}

Region to_region(const ClipperLib::Paths& paths, const Grid& grid) {
  Region region;
  region.reserve(paths.size());
  for (const ClipperLib::Path& path : paths) {
    Polygon& polygon = region.emplace_back();
    polygon.reserve(path.size());
    for (const ClipperLib::IntPoint& p : path) {
      polygon.push_back(grid.origin +
                        glm::dvec2(static_cast<double>(p.X), static_cast<double>(p.Y)) / grid.scale);
    }
  }
  return region;
}

Region clip(const Region& a, const Region& b, ClipperLib::ClipType type) {
  const Grid grid = grid_of(a, b, 0.0);
  ClipperLib::Clipper clipper;
  clipper.AddPaths(to_paths(a, grid), ClipperLib::ptSubject, true);
  clipper.AddPaths(to_paths(b, grid), ClipperLib::ptClip, true);
  ClipperLib::Paths result;
  clipper.Execute(type, result, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
  return to_region(result, grid);
}

}  // namespace

Region unite(const Region& a, const Region& b) {
  return clip(a, b, ClipperLib::ctUnion);
}

Region intersect(const Region& a, const Region& b) {
  return clip(a, b, ClipperLib::ctIntersection);
}

Region subtract(const Region& a, const Region& b) {
  return clip(a, b, ClipperLib::ctDifference);
}

Region offset(const Region& region, double distance, double arc_tolerance) {
  const Grid grid = grid_of(region, {}, std::abs(distance));
  ClipperLib::ClipperOffset clipper(2.0, arc_tolerance * grid.scale);
  clipper.AddPaths(to_paths(region, grid), ClipperLib::jtRound, ClipperLib::etClosedPolygon);
  ClipperLib::Paths result;
  clipper.Execute(result, distance * grid.scale);
  return to_region(result, grid);
}

double area_of(const Region& region) {
  double area = 0.0;
  for (const Polygon& polygon : region) area += signed_area(polygon);
  return area;
}

Polygon largest(const Region& region) {
  const auto best = std::max_element(region.begin(), region.end(), [](const Polygon& a, const Polygon& b) {
    return signed_area(a) < signed_area(b);
  });
  return best == region.end() ? Polygon{} : *best;
}

}  // namespace rejoin::outline::detail
