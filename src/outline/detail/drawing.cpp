#include "outline/detail/drawing.hpp"

#include <algorithm>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/ascii.hpp"
#include "core/files.hpp"
#include "core/png_mark.hpp"
#include "picture/image_file.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr std::size_t kMaxPixels = 120000000;
constexpr double kNothing = 1e-6;  // of opacity

/// The picture's colours with what `behind` gives where it is transparent.
/// \param behind  (a channel times alpha, alpha) -> that channel of what is seen through it
template <typename Behind>
cv::Mat visible_colours(const Piece& piece, const Behind& behind) {
  std::vector<cv::Mat> planes;
  cv::split(picture::load_image(piece.path, kMaxPixels), planes);
  if (planes.size() == 4) {
    const cv::Mat alpha = planes[3];
    planes.resize(3);
    for (cv::Mat& plane : planes) {
      const cv::Mat seen = plane.mul(alpha);
      plane = seen + behind(seen, alpha).mul(1.0 - alpha);
    }
  }
  cv::Mat colours;
  cv::merge(planes, colours);
  return colours;
}

}  // namespace

bool is_picture(const Piece& piece) {
  return picture::has_picture_name(piece.path);
}

cv::Mat colours_of(const Piece& piece, int reach) {
  const cv::Size around(2 * reach + 1, 2 * reach + 1);
  cv::Mat soft;  // how much is opaque around a pixel
  return visible_colours(piece, [&](const cv::Mat& seen, const cv::Mat& alpha) {
    if (soft.empty()) {
      cv::blur(alpha, soft, around);
      soft = cv::max(soft, kNothing);
    }
    cv::Mat near;
    cv::blur(seen, near, around);
    return cv::Mat(near / soft);
  });
}

cv::Mat colours_on_white(const Piece& piece) {
  return visible_colours(piece, [](const cv::Mat& seen, const cv::Mat&) {
    return cv::Mat(seen.size(), CV_32F, cv::Scalar(1.0));
  });
}

const cv::Mat& LastPicture::colours(const Piece& piece, int reach) {
  return read(piece, reach);
}

const cv::Mat& LastPicture::on_white(const Piece& piece) {
  return read(piece, kOnWhite);
}

const cv::Mat& LastPicture::read(const Piece& piece, int reach) {
  if (piece.path != path_ || reach != reach_) {
    path_.clear();
    colours_.release();  // not two large pictures at a time
    colours_ = reach == kOnWhite ? colours_on_white(piece) : colours_of(piece, reach);
    path_ = piece.path;
    reach_ = reach;
  }
  return colours_;
}

cv::Mat resampled(const cv::Mat& colours, cv::Matx23d motion, const cv::Size& size, int border) {
  constexpr int kLongest = 16384;
  const int times = (std::max(colours.cols, colours.rows) + kLongest - 1) / kLongest;
  cv::Mat source = colours;
  if (times > 1) {
    cv::resize(colours, source, {(colours.cols + times - 1) / times, (colours.rows + times - 1) / times}, 0.0,
               0.0, cv::INTER_AREA);
    const cv::Vec2d step(static_cast<double>(colours.cols) / source.cols,
                         static_cast<double>(colours.rows) / source.rows);
    for (int row = 0; row < 2; ++row) {
      // The middle of the first pixel is that of as many of the larger picture.
      motion(row, 2) += 0.5 * (motion(row, 0) * (step[0] - 1.0) + motion(row, 1) * (step[1] - 1.0));
      motion(row, 0) *= step[0];
      motion(row, 1) *= step[1];
    }
  }
  cv::Mat placed;
  cv::warpAffine(source, placed, motion, size, cv::INTER_LINEAR, border, cv::Scalar(1.0, 1.0, 1.0));
  placed.convertTo(placed, CV_8UC3, 255.0);
  return placed;
}

std::string short_name(const std::string& full) {
  constexpr std::size_t kMost = 32;
  const std::string name = ascii(full);
  return name.size() <= kMost ? name : name.substr(0, 14) + "..." + name.substr(name.size() - 15);
}

void write_png(const std::filesystem::path& path, const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 6});
  write_file(path, marked_png({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
}

}  // namespace rejoin::outline::detail
