#include "outline/detail/drawing.hpp"

#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "core/ascii.hpp"
#include "core/files.hpp"
#include "outline/detail/image_file.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr std::size_t kMaxPixels = 120000000;

}  // namespace

bool is_picture(const Piece& piece) {
  return has_picture_name(piece.path);
}

cv::Mat colours_of(const Piece& piece) {
  std::vector<cv::Mat> planes;
  cv::split(load_image(piece.path, kMaxPixels), planes);
  planes.resize(3);
  cv::Mat colours;
  cv::merge(planes, colours);
  return colours;
}

std::string short_name(const std::string& full) {
  constexpr std::size_t kMost = 32;
  const std::string name = ascii(full);
  return name.size() <= kMost ? name : name.substr(0, 14) + "..." + name.substr(name.size() - 15);
}

void write_png(const std::filesystem::path& path, const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 6});
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace rejoin::outline::detail
