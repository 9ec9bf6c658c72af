#include "report/image.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/files.hpp"
#include "core/png_mark.hpp"

namespace rejoin::report {
namespace {

std::vector<std::uint8_t> encode(const Image& image, const char* extension,
                                 const std::vector<int>& settings) {
  cv::Mat pixels(image.height, image.width, CV_8UC3, const_cast<Colour*>(image.pixels.data()));
  cv::Mat swapped;
  cv::cvtColor(pixels, swapped, cv::COLOR_RGB2BGR);
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, swapped, bytes, settings);
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image) {
  return encode(image, ".png", {cv::IMWRITE_PNG_COMPRESSION, 6});
}

std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality) {
  return encode(image, ".jpg", {cv::IMWRITE_JPEG_QUALITY, quality, cv::IMWRITE_JPEG_OPTIMIZE, 1});
}

void write_png(const std::filesystem::path& path, const Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  write_file(path, marked_png({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
}

Colour mix(Colour a, Colour b, double share) {
  const glm::dvec3 blend = glm::mix(glm::dvec3(a), glm::dvec3(b), std::clamp(share, 0.0, 1.0));
  return Colour(glm::dvec3(blend + 0.5));
}

}  // namespace rejoin::report
