/// Pictures in memory and as PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

namespace rejoin::report {

using Colour = glm::u8vec3;  ///< sRGB

/// Rows from the top, three bytes a pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Colour> pixels;

  Image() = default;
  Image(int w, int h, Colour fill) : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, fill) {}

  Colour at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
  Colour& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

/// The PNG file's bytes (OpenCV's imgcodecs, which the project keeps for scans of flat fragments anyway). The
/// same picture gives the same bytes.
std::vector<std::uint8_t> encode_png(const Image& image);

/// The JPEG file's bytes.  The same picture gives the same bytes.
/// \param quality  1 .. 100
std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality);

/// With the program's mark, see core/png_mark.hpp.
/// \throws IoError the file cannot be written; it then does not appear at all
void write_png(const std::filesystem::path& path, const Image& image);

/// Straight between two colours, share 0 .. 1 of b.
Colour mix(Colour a, Colour b, double share);

}  // namespace rejoin::report
