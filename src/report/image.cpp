#include "report/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <system_error>

#include "core/error.hpp"

namespace rejoin::report {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& problem) {
  throw IoError(path.string(), problem, "check that the folder exists, is writable and has space");
}

std::string reason(const std::error_code& error) {
  return error ? error.message() : "unknown reason";
}

/// A name beside `path` that no other writer of this process uses.
std::filesystem::path beside(const std::filesystem::path& path) {
  static std::atomic<unsigned> count{0};
  std::filesystem::path result = path;
  result += fmt::format(".{}.part", count++);
  return result;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image) {
  cv::Mat pixels(image.height, image.width, CV_8UC3, const_cast<Colour*>(image.pixels.data()));
  cv::Mat swapped;
  cv::cvtColor(pixels, swapped, cv::COLOR_RGB2BGR);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", swapped, bytes, {cv::IMWRITE_PNG_COMPRESSION, 6});
  return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  const std::filesystem::path part = beside(path);
  std::error_code error;
  {
    std::ofstream stream(part, std::ios::binary);
    if (!stream) refuse(path, std::string("cannot be created (") + std::strerror(errno) + ")");
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
      std::filesystem::remove(part, error);
      refuse(path, "cannot be written to its end");
    }
  }
  std::filesystem::rename(part, path, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  refuse(path, "cannot be put in place (" + reason(error) + ")");
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder))
    refuse(folder, "is not a folder and cannot be made one (" + reason(error) + ")");
}

Colour mix(Colour a, Colour b, double share) {
  const glm::dvec3 blend = glm::mix(glm::dvec3(a), glm::dvec3(b), std::clamp(share, 0.0, 1.0));
  return Colour(glm::dvec3(blend + 0.5));
}

}  // namespace rejoin::report
