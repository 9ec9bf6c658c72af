#include "shatter/noise.hpp"

#include <array>
#include <cmath>

namespace rejoin::shatter {
namespace {

/// SplitMix64's finaliser.
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

std::uint64_t corner_hash(std::uint64_t seed, const glm::i64vec3& corner) {
  const auto part = [](std::int64_t v, std::uint64_t factor) {
    return static_cast<std::uint64_t>(v) * factor;
  };
  return mixed(seed ^ part(corner.x, 0x9e3779b97f4a7c15ULL) ^ part(corner.y, 0xc2b2ae3d27d4eb4fULL) ^
               part(corner.z, 0x165667b19e3779f9ULL));
}

/// Towards the middle of one of a cube's twelve edges.
double slope(std::uint64_t bits, const glm::dvec3& d) {
  constexpr std::array<glm::dvec3, 16> kEdges{{{1, 1, 0},
                                               {-1, 1, 0},
                                               {1, -1, 0},
                                               {-1, -1, 0},
                                               {1, 0, 1},
                                               {-1, 0, 1},
                                               {1, 0, -1},
                                               {-1, 0, -1},
                                               {0, 1, 1},
                                               {0, -1, 1},
                                               {0, 1, -1},
                                               {0, -1, -1},
                                               {1, 1, 0},
                                               {-1, 1, 0},
                                               {0, -1, 1},
                                               {0, -1, -1}}};
  return glm::dot(kEdges[bits & 15U], d);
}

glm::dvec3 octave(std::uint64_t seed, const glm::dvec3& p, int components) {
  const glm::dvec3 low = glm::floor(p);
  const glm::dvec3 f = p - low;
  const glm::dvec3 w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  const glm::i64vec3 cell(low);
  glm::dvec3 sum(0.0);
  for (int k = 0; k < 8; ++k) {
    const glm::ivec3 step(k & 1, (k >> 1) & 1, (k >> 2) & 1);
    const std::uint64_t hash = corner_hash(seed, cell + glm::i64vec3(step));
    const glm::dvec3 d = f - glm::dvec3(step);
    const double weight =
        (step.x != 0 ? w.x : 1.0 - w.x) * (step.y != 0 ? w.y : 1.0 - w.y) * (step.z != 0 ? w.z : 1.0 - w.z);
    for (int c = 0; c < components; ++c) sum[c] += weight * slope(hash >> (8U * static_cast<unsigned>(c)), d);
  }
  return sum;
}

glm::dvec3 summed(const Noise& noise, const glm::dvec3& point, int components) {
  glm::dvec3 sum(0.0);
  double wavelength = noise.wavelength;
  double amplitude = noise.amplitude;
  for (std::uint64_t k = 0; wavelength >= noise.finest && amplitude > 0.0; ++k) {
    sum += amplitude * octave(mixed(noise.seed + k), point / wavelength, components);
    wavelength /= 2.0;
    amplitude *= noise.falloff;
  }
  return sum;
}

}  // namespace

glm::dvec3 Noise::at(const glm::dvec3& point) const {
  return summed(*this, point, 3);
}

double Noise::value(const glm::dvec3& point) const {
  return summed(*this, point, 1).x;
}

}  // namespace rejoin::shatter
