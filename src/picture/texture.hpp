/// Pictures that lie on surfaces.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace rejoin::picture {

/// Colours of a picture by place.
class Texture {
 public:
  /// \param bytes  of a PNG, JPEG or TIFF   \param name  for errors
  /// \throws InputError it is no such picture, has more than 16,384 x 16,384 pixels, or is damaged
  Texture(const std::string& bytes, const std::string& name);

  /// sRGB of the pixel at a place: (0, 0) is the upper left corner, (1, 1) the lower right one; beyond them the picture goes on
  /// repeating itself.  White where a coordinate is not finite.
  glm::u8vec3 at(const glm::dvec2& place) const;

 private:
  std::size_t width_ = 0;
  std::size_t height_ = 0;
  std::vector<glm::u8vec3> pixels_;  ///< row by row
};

}  // namespace rejoin::picture
