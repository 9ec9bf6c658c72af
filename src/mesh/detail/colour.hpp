/// Colours as bytes; sRGB bytes to linear light and back (IEC 61966-2-1): glTF stores vertex colours linear.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace rejoin::mesh::detail {

/// Rounded and held within 0 .. 255; what is no number is 0.
inline glm::u8vec3 to_bytes(const glm::dvec3& value) {
  glm::u8vec3 bytes;
  for (int k = 0; k < 3; ++k)
    bytes[k] =
        value[k] > 0 ? static_cast<std::uint8_t>(std::lround(std::min(value[k], 255.0))) : std::uint8_t{0};
  return bytes;
}

/// What real numbers are multiplied by to make bytes: 255, or 1 where some of them are no shares, as some programs write bytes.
/// \param brightest  the largest of all components
inline double scale_of_real_colours(double brightest) {
  return brightest > 1.5 ? 1.0 : 255.0;
}

inline glm::dvec3 to_linear(const glm::u8vec3& srgb) {
  glm::dvec3 linear;
  for (int k = 0; k < 3; ++k) {
    const double value = srgb[k] / 255.0;
    linear[k] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  }
  return linear;
}

inline glm::u8vec3 to_srgb(const glm::dvec3& linear) {
  glm::u8vec3 srgb;
  for (int k = 0; k < 3; ++k) {
    const double value = linear[k] > 0 ? std::min(linear[k], 1.0) : 0.0;
    const double curved = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
    srgb[k] = static_cast<std::uint8_t>(std::lround(255.0 * curved));
  }
  return srgb;
}

}  // namespace rejoin::mesh::detail
