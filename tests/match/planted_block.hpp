/// A block cut in two along an analytic wavy surface: the truth is known exactly.
#pragma once

#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "core/rigid.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::match::testing {

inline constexpr double kHalfX = 40;  // mm
inline constexpr double kHalfY = 30;
inline constexpr double kHalfZ = 25;

/// Height of the cut over the block's middle plane, mm: no symmetry, slopes up to about 0.8.
inline double cut_height(double x, double y) {
  return 4 * std::sin(0.11 * x + 0.4) * std::cos(0.13 * y - 0.3) + 2 * std::sin(0.21 * x - 0.17 * y) +
         0.06 * x + 1.5 * std::sin(0.4 * y + 0.1 * x);
}

/// Half of the block, closed, in the block's frame: below the cut, or above it.
/// \param share  of its length and width that is left, about its middle
inline mesh::Mesh half_block(bool below, int cells, double share = 1.0) {
  mesh::Mesh half;
  const auto vertex = [&](int i, int j, bool cut) {
    const double x = share * kHalfX * (2.0 * i / cells - 1);
    const double y = share * kHalfY * (2.0 * j / cells - 1);
    return glm::vec3(x, y, cut ? cut_height(x, y) : (below ? -kHalfZ : kHalfZ));
  };
  const auto index = [&](int i, int j, bool cut) {
    return static_cast<std::uint32_t>((cut ? 0 : (cells + 1) * (cells + 1)) + j * (cells + 1) + i);
  };
  for (const bool cut : {true, false}) {
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) half.vertices.push_back(vertex(i, j, cut));
    }
  }
  const auto quad = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s, bool flip) {
    half.faces.push_back(flip ? glm::uvec3(p, r, q) : glm::uvec3(p, q, r));
    half.faces.push_back(flip ? glm::uvec3(p, s, r) : glm::uvec3(p, r, s));
  };
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      for (const bool cut : {true, false}) {
        quad(index(i, j, cut), index(i + 1, j, cut), index(i + 1, j + 1, cut), index(i, j + 1, cut),
             cut != below);
      }
    }
  }
  for (int k = 0; k < cells; ++k) {
    const int n = cells;
    quad(index(k, 0, false), index(k + 1, 0, false), index(k + 1, 0, true), index(k, 0, true), !below);
    quad(index(n, k, false), index(n, k + 1, false), index(n, k + 1, true), index(n, k, true), !below);
    quad(index(k + 1, n, false), index(k, n, false), index(k, n, true), index(k + 1, n, true), !below);
    quad(index(0, k + 1, false), index(0, k, false), index(0, k, true), index(0, k + 1, true), !below);
  }
  return half;
}

inline Rigid random_rigid(Random& random, double reach) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
  return {axis_rotation(axis, random.uniform(0, 3.1)),
          glm::dvec3(random.uniform(-reach, reach), random.uniform(-reach, reach),
                     random.uniform(-reach, reach))};
}

/// The mesh moved, with an origin of its own somewhere near.
inline mesh::Mesh moved(const mesh::Mesh& mesh, const Rigid& motion, const glm::dvec3& offset) {
  mesh::Mesh result = mesh;
  result.origin = motion.translation + offset;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    result.vertices[v] = glm::vec3(motion(glm::dvec3(mesh.vertices[v])) - result.origin);
  }
  return result;
}

/// The two halves in unrelated poses, and the truth.
struct PlantedPair {
  mesh::Mesh a;  ///< below the cut
  mesh::Mesh b;  ///< above it
  Rigid to_a;    ///< block frame -> A's file coordinates
  Rigid to_b;
  Rigid truth;             ///< B's file coordinates -> A's
  glm::dvec3 direction_a;  ///< of the cut, outwards, file axes
  glm::dvec3 direction_b;
};

inline PlantedPair planted_pair(std::uint64_t seed, int cells = 48) {
  Random random(seed);
  const Rigid to_a = random_rigid(random, 500);
  const Rigid to_b = random_rigid(random, 500);
  const glm::dvec3 up(0, 0, 1);
  return {moved(half_block(true, cells), to_a, {3, -2, 1}),
          moved(half_block(false, cells), to_b, {-4, 5, 2}),
          to_a,
          to_b,
          to_a * inverse(to_b),
          to_a.rotation * up,
          to_b.rotation * -up};
}

}  // namespace rejoin::match::testing
