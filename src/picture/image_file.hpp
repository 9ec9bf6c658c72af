/// Pictures from files, checked before they are decoded.
#pragma once

#include <cstddef>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rejoin::picture {

/// What a picture's header claims.
struct ImageHeader {
  std::size_t width = 0;
  std::size_t height = 0;
  double dots_per_inch = 0.0;  ///< across; 0: not told
  std::size_t bits = 8;        ///< a channel; told of a TIFF
  std::size_t samples = 1;     ///< a pixel; told of a TIFF
  std::size_t pages = 1;
  int orientation = 1;  ///< as Exif has it; told of a PNG and a TIFF: the decoder turns a JPEG
};

/// Whether a file's name ends as those of pictures that are read do.
bool has_picture_name(const std::filesystem::path& path);

/// Size from the header of a PNG, JPEG or TIFF; nullopt if it is none or its header is broken.
std::optional<ImageHeader> image_header(std::string_view bytes);

/// Decodes a PNG, JPEG or TIFF with the channels that it has, blue before red, upright as its orientation says; of several pages
/// the first.  Calls on several threads wait for each other.
/// \param name  for errors   \param max_pixels  refused above   \param notes  gets what is not read of the file
/// \throws InputError it is no such picture, is larger, or is damaged
cv::Mat decode_image(const std::string& bytes, const std::string& name, std::size_t max_pixels,
                     std::vector<std::string>* notes = nullptr);

/// The same of a file, as floats 0..1 with 3 channels (blue, green, red) or 4 (and alpha).
/// \throws IoError   the file cannot be read   \throws InputError as decode_image()
cv::Mat load_image(const std::string& path, std::size_t max_pixels,
                   std::vector<std::string>* notes = nullptr);

}  // namespace rejoin::picture
