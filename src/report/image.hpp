/// Pictures in memory and as PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string_view>
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

/// \throws IoError the file cannot be written; it then does not appear at all
void write_png(const std::filesystem::path& path, const Image& image);

/// Writes bytes beside the path and renames, so that a file is whole or not there.
/// \throws IoError the file cannot be written
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Makes the folder and those above it.
/// \throws IoError it cannot be made or written into
void make_folder(const std::filesystem::path& folder);

/// Straight between two colours, share 0 .. 1 of b.
Colour mix(Colour a, Colour b, double share);

}  // namespace rejoin::report
