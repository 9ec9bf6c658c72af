#include "mesh/detail/triangulate.hpp"
#include "core/angle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"

namespace rejoin::mesh::detail {
namespace {

/// A polygon that its middle sees all of, with corners at random distances, in a plane of its own.
Soup star(std::uint32_t corners, std::uint64_t seed) {
  Random random(seed);
  const glm::dvec3 x = glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
  const glm::dvec3 y = glm::normalize(glm::cross(x, glm::dvec3(random.normal(), random.normal(), 1)));
  Soup soup;
  for (std::uint32_t k = 0; k < corners; ++k) {
    const double angle = kTurn * k / corners;
    const double radius = 1.0 + 9.0 * random.uniform();
    soup.points.push_back(radius * (std::cos(angle) * x + std::sin(angle) * y));
    soup.corners.push_back(k);
  }
  soup.sizes.push_back(corners);
  return soup;
}

/// A polygon in the plane of x and y.
Soup flat(const std::vector<glm::dvec2>& points) {
  Soup soup;
  for (const glm::dvec2& point : points) {
    soup.corners.push_back(static_cast<std::uint32_t>(soup.points.size()));
    soup.points.emplace_back(point, 0.0);
  }
  soup.sizes.push_back(static_cast<std::uint32_t>(points.size()));
  return soup;
}

/// A band of two turns round a point.
Soup spiral(int corners_a_side) {
  std::vector<glm::dvec2> points;
  for (int k = 0; k < 2 * corners_a_side; ++k) {
    const bool outside = k >= corners_a_side;
    const double angle = 2 * kTurn * (outside ? 2 * corners_a_side - 1 - k : k) / corners_a_side;
    const double radius = 1.0 + angle + (outside ? 3.0 : 0.0);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return flat(points);
}

/// A square whose sides have corners where they do not bend.
Soup square(int corners_a_side) {
  std::vector<glm::dvec2> points;
  const double last = corners_a_side;
  for (int k = 0; k < corners_a_side; ++k) points.emplace_back(k, 0.0);
  for (int k = 0; k < corners_a_side; ++k) points.emplace_back(last, k);
  for (int k = 0; k < corners_a_side; ++k) points.emplace_back(last - k, last);
  for (int k = 0; k < corners_a_side; ++k) points.emplace_back(0.0, last - k);
  return flat(points);
}

glm::dvec3 doubled_area(const Soup& soup, const glm::uvec3& face) {
  const glm::dvec3& a = soup.points[face.x];
  return glm::cross(soup.points[face.y] - a, soup.points[face.z] - a);
}

/// Of the polygon, by the triangles to its middle.
glm::dvec3 doubled_area(const Soup& soup) {
  glm::dvec3 sum(0.0);
  const std::size_t count = soup.points.size();
  for (std::size_t k = 0; k < count; ++k) sum += glm::cross(soup.points[k], soup.points[(k + 1) % count]);
  return sum;
}

/// Looks at every corner and every point in each step.
std::vector<glm::uvec3> by_brute_force(const Soup& soup) {
  const glm::dvec3 normal = doubled_area(soup);
  std::vector<std::uint32_t> left = soup.corners;
  const auto at = [&](std::size_t i) { return left[i % left.size()]; };
  const auto turn = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return glm::dot(normal, doubled_area(soup, {a, b, c}));
  };
  const auto is_ear = [&](std::size_t i) {
    const std::uint32_t a = at(i + left.size() - 1);
    const std::uint32_t b = at(i);
    const std::uint32_t c = at(i + 1);
    return turn(a, b, c) > 0 && std::none_of(left.begin(), left.end(), [&](std::uint32_t p) {
             return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
                    turn(c, a, p) >= 0;
           });
  };
  std::vector<glm::uvec3> faces;
  while (left.size() > 3) {
    std::size_t best = left.size();
    double shortest = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const glm::dvec3 cut = soup.points[at(i + left.size() - 1)] - soup.points[at(i + 1)];
      if (!is_ear(i) || (best < left.size() && glm::dot(cut, cut) >= shortest)) continue;
      best = i;
      shortest = glm::dot(cut, cut);
    }
    faces.emplace_back(at(best + left.size() - 1), at(best), at(best + 1));
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  faces.emplace_back(left[0], left[1], left[2]);
  return faces;
}

TEST(Triangulate, CutsTheShortestEarOffAsBruteForceFindsIt) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Soup soup = star(4 + static_cast<std::uint32_t>(seed % 40), seed);
    EXPECT_EQ(triangulate(soup), by_brute_force(soup)) << "seed " << seed;
  }
}

TEST(Triangulate, CutsTheShortestEarOffWhereCornersLieInManyCells) {
  EXPECT_EQ(triangulate(spiral(150)), by_brute_force(spiral(150)));
  EXPECT_EQ(triangulate(square(60)), by_brute_force(square(60)));
  EXPECT_EQ(triangulate(star(300, 5)), by_brute_force(star(300, 5)));
}

TEST(Triangulate, OfThousandsOfCornersCoversThePolygonOnce) {
  const Soup soup = star(100000, 7);
  const auto faces = triangulate(soup);
  ASSERT_EQ(faces.size(), 99998U);
  const glm::dvec3 whole = doubled_area(soup);
  double covered = 0;
  for (const glm::uvec3& face : faces) {
    const double area = glm::dot(glm::normalize(whole), doubled_area(soup, face));
    ASSERT_GE(area, -1e-9);
    covered += area;
  }
  EXPECT_NEAR(covered, glm::length(whole), 1e-6 * glm::length(whole));
}

}  // namespace
}  // namespace rejoin::mesh::detail
