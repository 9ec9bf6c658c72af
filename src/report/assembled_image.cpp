#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "report/outline_pictures.hpp"

namespace rejoin::report {
namespace {

/// Fills of pieces without a picture, blue green red.
const std::array<cv::Scalar, 6> kFills{cv::Scalar(150, 190, 225, 255), cv::Scalar(205, 190, 150, 255),
                                       cv::Scalar(160, 215, 170, 255), cv::Scalar(200, 165, 205, 255),
                                       cv::Scalar(150, 215, 220, 255), cv::Scalar(190, 190, 190, 255)};
constexpr int kMargin = 4;
constexpr int kSubpixelBits = 4;

struct Frame {
  glm::dvec2 low{0.0};
  double scale = 1.0;
  cv::Size size;

  glm::dvec2 operator()(const glm::dvec2& p) const { return (p - low) * scale + glm::dvec2(kMargin); }
};

Frame frame_of(const std::vector<outline::Piece>& pieces, const std::vector<outline::Planar>& poses,
               int most_pixels) {
  glm::dvec2 low(1e300);
  glm::dvec2 high(-1e300);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const glm::dvec2& p : pieces[i].outline.points) {
      low = glm::min(low, poses[i](p));
      high = glm::max(high, poses[i](p));
    }
  }
  const glm::dvec2 size = high - low;
  Frame frame{low, 1.0, {}};
  const double longest = std::max(size.x, size.y);
  const bool picture = std::any_of(pieces.begin(), pieces.end(),
                                   [](const auto& piece) { return !piece.outline.colour.empty(); });
  if (!picture || longest > most_pixels)
    frame.scale = (picture ? most_pixels : std::min(most_pixels, 1600)) / longest;
  frame.size = {static_cast<int>(std::ceil(size.x * frame.scale)) + 2 * kMargin,
                static_cast<int>(std::ceil(size.y * frame.scale)) + 2 * kMargin};
  return frame;
}

std::vector<cv::Point> pixels(const std::vector<glm::dvec2>& polygon, const outline::Planar& pose,
                              const Frame& frame) {
  std::vector<cv::Point> result;
  result.reserve(polygon.size());
  for (const glm::dvec2& p : polygon) {
    const glm::dvec2 at = frame(pose(p)) * static_cast<double>(1 << kSubpixelBits);
    result.emplace_back(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)));
  }
  return result;
}

/// 255 inside the piece where it lies.
cv::Mat mask_of(const outline::Piece& piece, const outline::Planar& pose, const Frame& frame) {
  cv::Mat mask(frame.size, CV_8U, cv::Scalar(0));
  std::vector<std::vector<cv::Point>> polygons{pixels(piece.outline.points, pose, frame)};
  for (const auto& hole : piece.outline.holes) polygons.push_back(pixels(hole, pose, frame));
  cv::fillPoly(mask, polygons, cv::Scalar(255), cv::LINE_AA, kSubpixelBits);
  return mask;
}

/// The piece's picture where it lies; alpha is full everywhere.
cv::Mat moved_picture(const outline::Piece& piece, const outline::Planar& pose, const Frame& frame) {
  cv::Mat image = cv::imread(piece.path, cv::IMREAD_COLOR);
  if (image.empty())
    throw IoError(piece.path, "cannot be read again for the picture", "leave the files in place");
  cv::cvtColor(image, image, cv::COLOR_BGR2BGRA);
  const glm::dvec2 x = pose.direction({1, 0}) * frame.scale;
  const glm::dvec2 y = pose.direction({0, 1}) * frame.scale;
  const glm::dvec2 origin = frame(pose({0, 0}));
  const cv::Mat motion = (cv::Mat_<double>(2, 3) << x.x, y.x, origin.x, x.y, y.y, origin.y);
  cv::Mat moved;
  cv::warpAffine(image, moved, motion, frame.size, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return moved;
}

/// Lays a piece over the canvas by its mask.
void lay(cv::Mat& canvas, const cv::Mat& colours, const cv::Mat& mask) {
  for (int y = 0; y < canvas.rows; ++y) {
    for (int x = 0; x < canvas.cols; ++x) {
      const int share = mask.at<std::uint8_t>(y, x);
      if (share == 0) continue;
      auto& under = canvas.at<cv::Vec4b>(y, x);
      const auto& over = colours.at<cv::Vec4b>(y, x);
      for (int c = 0; c < 3; ++c) {
        const int below = under[3] == 0 ? over[c] : under[c];
        under[c] = static_cast<std::uint8_t>((over[c] * share + below * (255 - share)) / 255);
      }
      under[3] = static_cast<std::uint8_t>(std::min(255, under[3] + share));
    }
  }
}

}  // namespace

std::vector<std::uint8_t> assembled_png(const std::vector<outline::Piece>& pieces,
                                        const std::vector<outline::Planar>& poses, int most_pixels) {
  const Frame frame = frame_of(pieces, poses, most_pixels);
  cv::Mat canvas(frame.size, CV_8UC4, cv::Scalar(0, 0, 0, 0));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const bool picture = !pieces[i].outline.colour.empty();
    const cv::Mat colours = picture ? moved_picture(pieces[i], poses[i], frame)
                                    : cv::Mat(frame.size, CV_8UC4, kFills.at(i % kFills.size()));
    lay(canvas, colours, mask_of(pieces[i], poses[i], frame));
  }
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", canvas, bytes);
  return bytes;
}

}  // namespace rejoin::report
