#include "outline/shatter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "outline/detail/breaking.hpp"
#include "outline/detail/clip.hpp"
#include "outline/scan.hpp"

namespace rejoin::outline {
namespace {

std::vector<glm::dvec2> in_object(const ShatteredPiece& piece) {
  std::vector<glm::dvec2> points;
  for (const glm::dvec2& p : piece.border) points.push_back(piece.to_object(p));
  if (piece.to_object.flipped) std::reverse(points.begin(), points.end());
  return points;
}

double nearest(const std::vector<glm::dvec2>& polygon, const glm::dvec2& p) {
  double least = 1e300;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2& a = polygon[i];
    const glm::dvec2 along = polygon[(i + 1) % polygon.size()] - a;
    const double share = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
    least = std::min(least, glm::distance(p, a + share * along));
  }
  return least;
}

ShatterOptions small_shape() {
  ShatterOptions options;
  options.resolution = 40;
  options.flip = true;
  return options;
}

TEST(FlatShatter, PiecesFillTheObjectWithoutOverlap) {
  ShatterOptions options = small_shape();
  const Shattered broken = shatter(options);
  options.pieces = 1;
  const Shattered whole = shatter(options);
  ASSERT_EQ(broken.pieces.size(), 8U);
  detail::Region sum;
  double area = 0.0;
  for (const ShatteredPiece& piece : broken.pieces) {
    const std::vector<glm::dvec2> border = in_object(piece);
    EXPECT_GT(signed_area(border), 0.0);
    area += signed_area(border);
    sum = detail::unite(sum, {border});
  }
  const double expected = signed_area(whole.pieces[0].border);
  EXPECT_NEAR(area, expected, 1e-6 * expected);  // no overlap
  EXPECT_NEAR(detail::area_of(sum), expected, 1e-6 * expected);
}

TEST(FlatShatter, CommonBoundariesAreHalfOfWhatIsNotTheObjectsBorder) {
  ShatterOptions options = small_shape();
  const Shattered broken = shatter(options);
  options.pieces = 1;
  const double rim = perimeter(shatter(options).pieces[0].border);
  double borders = 0.0;
  for (const ShatteredPiece& piece : broken.pieces) borders += perimeter(piece.border);
  double joins = 0.0;
  for (const TrueJoin& join : broken.joins) {
    EXPECT_LT(join.a, join.b);
    joins += join.length;
  }
  EXPECT_NEAR(joins, (borders - rim) / 2.0, 1e-6 * borders);
}

TEST(FlatShatter, BothSidesOfABreakFollowOneLine) {
  const Shattered broken = shatter(small_shape());
  std::map<std::size_t, int> met;
  for (const TrueJoin& join : broken.joins) {
    const std::vector<glm::dvec2> a = in_object(broken.pieces[join.a]);
    double along = 0.0;
    for (const glm::dvec2& p : broken.pieces[join.b].piece.outline.points)
      if (nearest(a, broken.pieces[join.b].to_object(p)) < 0.01) along += 1.0;  // samples are a pixel apart
    EXPECT_NEAR(along, join.length, 0.1 * join.length + 12.0)
        << join.a << " " << join.b;  // corners are cut by sampling
  }
}

TEST(FlatShatter, TheTwoSidesShareNoSample) {
  const Shattered broken = shatter(small_shape());
  for (const TrueJoin& join : broken.joins) {
    int same = 0;
    for (const glm::dvec2& p : broken.pieces[join.a].piece.outline.points) {
      for (const glm::dvec2& q : broken.pieces[join.b].piece.outline.points)
        if (glm::distance(broken.pieces[join.a].to_object(p), broken.pieces[join.b].to_object(q)) < 1e-6)
          ++same;
    }
    EXPECT_EQ(same, 0);
  }
}

TEST(FlatShatter, WearTakesMaterialOffEverySide) {
  ShatterOptions options = small_shape();
  const Shattered sharp = shatter(options);
  options.wear = 2.0;
  const Shattered worn = shatter(options);
  for (std::size_t n = 0; n < sharp.pieces.size(); ++n) {
    const double area = signed_area(sharp.pieces[n].border);
    const double left = signed_area(worn.pieces[n].border);
    const double strip = options.wear * perimeter(sharp.pieces[n].border);
    EXPECT_LT(left, area - 0.7 * strip);
    EXPECT_GT(left, area - 4.0 * strip);  // bites, and necks that wear through
  }
}

TEST(FlatShatter, TilesAreBrokenRoughlyIntoAllPieces) {
  ShatterOptions options;
  options.kind = ObjectKind::Tile;
  options.objects = 2;
  options.pieces = 9;
  options.resolution = 60;
  const Shattered broken = shatter(options);
  ASSERT_EQ(broken.pieces.size(), 9U);
  EXPECT_EQ(broken.pieces[4].object, 0U);
  EXPECT_EQ(broken.pieces[5].object, 1U);
  EXPECT_DOUBLE_EQ(broken.pixel_size, 25.4 / 60);
  for (const TrueJoin& join : broken.joins)
    EXPECT_EQ(broken.pieces[join.a].object, broken.pieces[join.b].object);
}

TEST(FlatShatter, TheSameSeedGivesTheSamePiecesForAnyNumberOfThreads) {
  ShatterOptions options = small_shape();
  options.objects = 2;
  options.noise = 0.2;
  options.wear = 1.0;
  std::string texts[2];
  for (int threads = 1; threads <= 2; ++threads) {
    const ThreadLimit limit(threads);
    const Shattered broken = shatter(options);
    texts[threads - 1] = truth_json(broken, options, ".csv");
    for (const ShatteredPiece& piece : broken.pieces) {
      const std::vector<std::uint8_t> png = picture_png(piece, options);
      texts[threads - 1].append(png.begin(), png.end());
    }
  }
  EXPECT_EQ(texts[0], texts[1]);
  ++options.seed;
  EXPECT_NE(truth_json(shatter(options), options, ".csv"), texts[0]);
}

TEST(FlatShatter, RefusesWhatCannotBeMade) {
  ShatterOptions options = small_shape();
  options.pieces = 5000;
  EXPECT_THROW(shatter(options), InputError);
  options.pieces = 0;
  EXPECT_THROW(shatter(options), InputError);
  options = small_shape();
  options.noise = std::nan("");
  EXPECT_THROW(shatter(options), InputError);
}

TEST(Scan, CoverageAddsUpToTheArea) {
  const std::vector<glm::dvec2> triangle{{2.3, 1.9}, {37.1, 8.4}, {12.7, 29.6}};
  double sum = 0.0;
  for (const float share : pixel_coverage(triangle, 40, 40)) sum += share;
  EXPECT_NEAR(sum, signed_area(triangle), 0.5);  // eight lines a row
}

TEST(Scan, EdgePixelsOfASquareAreItsOutermostPixels) {
  const std::vector<glm::dvec2> square{{0.5, 0.5}, {10.5, 0.5}, {10.5, 10.5}, {0.5, 10.5}};
  const std::vector<glm::dvec2> pixels = edge_pixels(square);
  EXPECT_EQ(pixels.size(), 36U);
  EXPECT_DOUBLE_EQ(signed_area(pixels), 81.0);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    EXPECT_DOUBLE_EQ(glm::distance(pixels[i], pixels[(i + 1) % pixels.size()]), 1.0);
}

}  // namespace
}  // namespace rejoin::outline
