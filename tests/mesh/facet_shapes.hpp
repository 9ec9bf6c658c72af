/// A plate, slab or block and a sherd for the tests of facets.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "mesh/mesh.hpp"

namespace rejoin::mesh::test {

/// Closed box of the given full sizes, every side cut into cells x cells quads, z moved by `bump` on the top.
template <class Bump>
Mesh box(const glm::vec3& size, int cells, Bump bump) {
  Mesh mesh;
  const auto side = [&](glm::vec3 corner, glm::vec3 u, glm::vec3 v, bool top) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) {
        glm::vec3 p = corner + u * (static_cast<float>(i) / static_cast<float>(cells)) +
                      v * (static_cast<float>(j) / static_cast<float>(cells));
        if (top) p.z += bump(p.x, p.y);
        mesh.vertices.push_back(p);
      }
    }
    const auto row = static_cast<std::uint32_t>(cells + 1);
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(cells); ++j) {
      for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(cells); ++i) {
        const std::uint32_t p = first + j * row + i;
        mesh.faces.emplace_back(p, p + 1, p + row + 1);
        mesh.faces.emplace_back(p, p + row + 1, p + row);
      }
    }
  };
  const glm::vec3 x(size.x, 0, 0);
  const glm::vec3 y(0, size.y, 0);
  const glm::vec3 z(0, 0, size.z);
  side({0, 0, 0}, y, x, false);
  side(z, x, y, true);
  side({0, 0, 0}, x, z, false);
  side(y, z, x, false);
  side({0, 0, 0}, z, y, false);
  side(x, y, z, false);
  return mesh;
}

inline float flat(float /*x*/, float /*y*/) {
  return 0.0F;
}

/// A quarter of a thick cylinder shell: outer radius 50, wall 5, height 60; a sherd with known fracture surfaces.
inline Mesh shell(int around, int up) {
  const auto point = [&](double angle, double r, double h) {
    return glm::vec3(r * std::cos(angle), r * std::sin(angle), h);
  };
  Mesh mesh;
  const auto sheet = [&](int n, int m, const auto& at, bool flip) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int j = 0; j <= m; ++j) {
      for (int i = 0; i <= n; ++i)
        mesh.vertices.push_back(at(static_cast<double>(i) / n, static_cast<double>(j) / m));
    }
    const auto row = static_cast<std::uint32_t>(n + 1);
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(m); ++j) {
      for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n); ++i) {
        const std::uint32_t p = first + j * row + i;
        glm::uvec3 a(p, p + 1, p + row + 1);
        glm::uvec3 b(p, p + row + 1, p + row);
        if (flip) {
          std::swap(a.y, a.z);
          std::swap(b.y, b.z);
        }
        mesh.faces.push_back(a);
        mesh.faces.push_back(b);
      }
    }
  };
  const double quarter = std::numbers::pi / 2;
  sheet(
      around, up, [&](double s, double t) { return point(s * quarter, 50, 60 * t); }, false);
  sheet(
      around, up, [&](double s, double t) { return point(s * quarter, 45, 60 * t); }, true);
  sheet(
      around, 6, [&](double s, double t) { return point(s * quarter, 45 + 5 * t, 60); }, true);
  sheet(
      around, 6, [&](double s, double t) { return point(s * quarter, 45 + 5 * t, 0); }, false);
  sheet(
      6, up, [&](double s, double t) { return point(0, 45 + 5 * s, 60 * t); }, false);
  sheet(
      6, up, [&](double s, double t) { return point(quarter, 45 + 5 * s, 60 * t); }, true);
  return mesh;
}

}  // namespace rejoin::mesh::test
