/// The halves of a planted block made ready to match, and what the tests of the matcher ask of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/angle.hpp"
#include "match/align.hpp"
#include "planted_block.hpp"

namespace rejoin::match::testing {

struct Pair {
  PlantedPair planted;
  Fragment a;
  Fragment b;
  Rigid truth;  ///< relative to the meshes' origins
};

inline Pair make_pair(std::uint64_t seed) {
  Pair pair{planted_pair(seed), {}, {}, {}};
  const Context context;
  pair.a = prepare("a", pair.planted.a, context);
  pair.b = prepare("b", pair.planted.b, context);
  pair.truth = Rigid{glm::dmat3(1.0), -pair.planted.a.origin} * pair.planted.truth *
               Rigid{glm::dmat3(1.0), pair.planted.b.origin};
  return pair;
}

inline double worst_offset(const Rigid& pose, const Rigid& truth, const mesh::Mesh& b) {
  double worst = 0;
  for (const auto& v : b.vertices)
    worst = std::max(worst, glm::distance(pose(glm::dvec3(v)), truth(glm::dvec3(v))));
  return worst;
}

/// What the broken surfaces alone are worth.
inline double strength_of_shape(Evidence evidence) {
  evidence.continuation = 0;
  return strength(evidence);
}

/// Half of a block cut along a plane.
inline Fragment flat_half(bool below) {
  mesh::Mesh half = half_block(below, 48);
  for (auto& v : half.vertices) {
    if (std::abs(v.z) < static_cast<float>(kHalfZ)) v.z = 0.0F;
  }
  return prepare(below ? "below" : "above", half, Context{});
}

/// Half of a block cut along grooves, as a moulding is run: the same all along y but for ripples.
inline Fragment grooved_half(bool below, double ripples = 0.0) {
  mesh::Mesh half = half_block(below, 48);
  for (auto& v : half.vertices) {
    if (std::abs(v.z) == static_cast<float>(kHalfZ)) continue;
    v.z = 3.0F * std::sin(0.2F * v.x) + std::sin(0.37F * v.x) + static_cast<float>(ripples) * std::sin(v.y);
  }
  return prepare(below ? "below" : "above", half, Context{});
}

}  // namespace rejoin::match::testing
