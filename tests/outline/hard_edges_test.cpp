/// Pictures whose pixels lie all in a piece or all out of it: black and white, binary alpha, turned by nearest neighbours.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "outline/detail/contour.hpp"
#include "outline/extract.hpp"
#include "outline/multiscale.hpp"
#include "outline/scan.hpp"
#include "outline/shatter.hpp"
#include "soft_disc.hpp"

namespace rejoin::outline {
namespace {

using Border = std::vector<glm::dvec2>;
using testing::Folder;

constexpr int kSide = 700;

Border rectangle(double width, double height, double degrees) {
  const double angle = degrees * M_PI / 180.0;
  const glm::dvec2 along = 0.5 * width * glm::dvec2(std::cos(angle), std::sin(angle));
  const glm::dvec2 across = 0.5 * height * glm::dvec2(-std::sin(angle), std::cos(angle));
  const glm::dvec2 middle(350.3, 349.8);
  return {middle - along - across, middle + along - across, middle + along + across, middle - along + across};
}

/// The share of each pixel inside a border, or 0 and 1 by the half.
cv::Mat scan_of(const Border& border, bool hard, int side = kSide) {
  std::vector<float> coverage = pixel_coverage(border, side, side);
  cv::Mat field = cv::Mat(side, side, CV_32F, coverage.data()).clone();
  if (hard) cv::threshold(field, field, 0.5, 1.0, cv::THRESH_BINARY);
  return field;
}

Piece read(const Folder& folder, const std::string& name, const cv::Mat& field) {
  cv::Mat picture;
  field.convertTo(picture, CV_8U, 255.0);
  cv::imwrite(folder.file(name), picture);
  return {name, folder.file(name), extract(folder.file(name)).pieces.at(0)};
}

double best_score(const std::vector<Piece>& pieces) {
  const auto matcher = make_multiscale();
  matcher->prepare(pieces);
  const PairResult result = matcher->match(0, 1, Context());
  return result.candidates.empty() ? 0.0 : result.candidates[0].score;
}

// A place that lies anywhere in a pixel is off its middle by 1 / sqrt(12) of it.
TEST(HardEdges, RasterIsThatOfPixelsAllInOrAllOut) {
  for (const double degrees : {2.0, 7.0, 20.0, 37.0}) {
    const Border border = rectangle(403.7, 251.3, degrees);
    EXPECT_NEAR(detail::raster_of(detail::contours(scan_of(border, true), 0.5F, 12)), std::sqrt(1.0 / 12.0),
                0.01)
        << degrees;
    EXPECT_LT(detail::raster_of(detail::contours(scan_of(border, false), 0.5F, 12)), 0.1) << degrees;
  }
}

TEST(HardEdges, StraightBordersSayNothing) {
  const Folder folder;
  for (const double degrees : {2.0, 7.0, 13.0, 20.0, 37.0}) {
    const std::vector<Piece> pieces{read(folder, "a.png", scan_of(rectangle(403.7, 251.3, degrees), true)),
                                    read(folder, "b.png", scan_of(rectangle(331.1, 287.9, degrees), true))};
    EXPECT_LT(best_score(pieces), 0.3) << degrees;
  }
}

TEST(HardEdges, BrokenPiecesAreStillJoined) {
  const Folder folder;
  ShatterOptions options;
  options.kind = ObjectKind::Tile;
  options.pieces = 2;
  options.resolution = 150.0;
  const Shattered broken = shatter(options);
  std::vector<Piece> pieces;
  for (const ShatteredPiece& piece : broken.pieces) {
    Border border = piece.border;
    glm::dvec2 low = border[0];
    for (const glm::dvec2& p : border) low = glm::min(low, p);
    for (glm::dvec2& p : border) p += 20.0 - low;
    pieces.push_back(read(folder, piece.piece.name + ".png", scan_of(border, true, 1200)));
  }
  EXPECT_GT(best_score(pieces), kSureScore);
}

}  // namespace
}  // namespace rejoin::outline
