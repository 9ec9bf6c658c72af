/// Fractal noise: what makes a cut as rough as a break.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace rejoin::shatter {

/// Smooth random field of three independent components (gradient noise, Perlin 2002), octaves summed.
struct Noise {
  std::uint64_t seed = 1;
  double wavelength = 1;  ///< of the coarsest octave, mesh units
  double amplitude = 0;   ///< of the coarsest octave, mesh units
  double finest = 1;      ///< octaves shorter than this are left out, mesh units
  double falloff =
      0.574;  ///< amplitude of an octave over that of the one before; 2^-0.8: measured on broken stone

  /// Displacement at a point; each component roughly within +-amplitude / (1 - falloff).
  glm::dvec3 at(const glm::dvec3& point) const;

  /// The first component alone.
  double value(const glm::dvec3& point) const;
};

}  // namespace rejoin::shatter
