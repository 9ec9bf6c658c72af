#include "outline/lcs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"
#include "outline/detail/local_alignment.hpp"
#include "outline/shatter.hpp"
#include "outline/stitch.hpp"

namespace rejoin::outline {
namespace {

std::vector<Piece> pieces_of(const Shattered& broken) {
  std::vector<Piece> pieces;
  for (const ShatteredPiece& piece : broken.pieces) pieces.push_back(piece.piece);
  return pieces;
}

Shattered broken_shape(bool flip) {
  ShatterOptions options;
  options.resolution = 60;
  options.pieces = 4;
  options.flip = flip;
  options.scan = ScanKind::Pixels;
  options.seed = 4;
  return shatter(options);
}

/// Mean distance of B's border from where it belongs.
double off(const Shattered& broken, std::size_t a, std::size_t b, const Planar& pose) {
  const Planar truth = inverse(broken.pieces[a].to_object) * broken.pieces[b].to_object;
  double sum = 0.0;
  for (const glm::dvec2& p : broken.pieces[b].border) sum += glm::distance(pose(p), truth(p));
  return sum / static_cast<double>(broken.pieces[b].border.size());
}

LcsOptions small_options() {
  LcsOptions options;
  options.window = 17;  // steps are shorter at this resolution
  return options;
}

class LcsTest : public ::testing::TestWithParam<bool> {};

TEST_P(LcsTest, FindsLongJoinsToTwoPixelsAndScoresThemAboveFalseOnes) {
  const Shattered broken = broken_shape(GetParam());
  const std::unique_ptr<Matcher> matcher = make_lcs(small_options());
  matcher->prepare(pieces_of(broken));
  double least_true = 1.0;
  double most_false = 0.0;
  for (std::size_t a = 0; a < broken.pieces.size(); ++a) {
    for (std::size_t b = a + 1; b < broken.pieces.size(); ++b) {
      const auto join = std::find_if(broken.joins.begin(), broken.joins.end(),
                                     [&](const TrueJoin& j) { return j.a == a && j.b == b; });
      const PairResult result = matcher->match(a, b, Context());
      const double score = result.candidates.empty() ? 0.0 : result.candidates[0].score;
      if (join == broken.joins.end()) most_false = std::max(most_false, score);
      if (join == broken.joins.end() || join->length < 250.0) continue;
      ASSERT_FALSE(result.candidates.empty());
      least_true = std::min(least_true, score);
      EXPECT_EQ(result.candidates[0].pose.flipped,
                broken.pieces[a].to_object.flipped != broken.pieces[b].to_object.flipped);
      EXPECT_LT(off(broken, a, b, result.candidates[0].pose), 2.0);
      EXPECT_NEAR(result.candidates[0].boundary.length, join->length, 0.1 * join->length);
      EXPECT_LT(
          join_areas(broken.pieces[a].piece.outline, broken.pieces[b].piece.outline, result.candidates[0])
              .overlap,
          2.0 * join->length);
    }
  }
  EXPECT_GT(least_true, most_false);
}

INSTANTIATE_TEST_SUITE_P(Pieces, LcsTest, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "SomeUpsideDown" : "AllFaceUp"; });

TEST(Lcs, PosesMirrorWhenThePairIsSwapped) {
  const Shattered broken = broken_shape(true);
  const std::unique_ptr<Matcher> matcher = make_lcs(small_options());
  matcher->prepare(pieces_of(broken));
  const TrueJoin& longest =
      *std::max_element(broken.joins.begin(), broken.joins.end(),
                        [](const auto& x, const auto& y) { return x.length < y.length; });
  const PairResult forth = matcher->match(longest.a, longest.b, Context());
  const PairResult back = matcher->match(longest.b, longest.a, Context());
  const Planar round = forth.candidates.at(0).pose * back.candidates.at(0).pose;
  EXPECT_FALSE(round.flipped);
  EXPECT_LT(angle_between(round, Planar{}), 0.01);
}

TEST(Lcs, CandidatesAreBestFirstAndDistinct) {
  const Shattered broken = broken_shape(true);
  const std::unique_ptr<Matcher> matcher = make_lcs(small_options());
  const std::vector<Piece> pieces = pieces_of(broken);
  matcher->prepare(pieces);
  const PairResult result = matcher->match(0, 1, Context());
  EXPECT_LE(result.candidates.size(), 6U);
  for (std::size_t k = 1; k < result.candidates.size(); ++k) {
    EXPECT_GE(result.candidates[k - 1].score, result.candidates[k].score);
    double far = 0.0;
    for (const glm::dvec2& p : pieces[1].outline.points)
      far = std::max(far, glm::distance(result.candidates[k - 1].pose(p), result.candidates[k].pose(p)));
    EXPECT_GT(far, 5.0);
  }
}

TEST(Lcs, DoesNotDependOnTheUnit) {
  const Shattered broken = broken_shape(false);
  std::vector<Piece> pieces = pieces_of(broken);
  const std::unique_ptr<Matcher> matcher = make_lcs(small_options());
  const TrueJoin& join = broken.joins.front();
  matcher->prepare(pieces);
  const PairResult pixels = matcher->match(join.a, join.b, Context());
  for (Piece& piece : pieces)
    for (glm::dvec2& p : piece.outline.points) p = p / 1024.0;  // a power of two: no rounding
  matcher->prepare(pieces);
  const PairResult small = matcher->match(join.a, join.b, Context());
  ASSERT_EQ(pixels.candidates.size(), small.candidates.size());
  EXPECT_NEAR(pixels.candidates[0].score, small.candidates[0].score, 1e-6);
  EXPECT_NEAR(pixels.candidates[0].boundary.length / 1024.0, small.candidates[0].boundary.length, 1e-6);
}

TEST(Lcs, ACancelledSearchReturnsAtOnce) {
  const Shattered broken = broken_shape(false);
  const std::unique_ptr<Matcher> matcher = make_lcs(small_options());
  matcher->prepare(pieces_of(broken));
  Context context;
  context.cancel();
  EXPECT_TRUE(matcher->match(0, 1, context).candidates.empty());
}

TEST(Lcs, RefusesWhatItCannotUse) {
  LcsOptions options;
  options.window = 26;
  EXPECT_THROW(make_lcs(options), InputError);
  options = {};
  options.match_deg = std::nan("");
  EXPECT_THROW(make_lcs(options), InputError);
  const std::unique_ptr<Matcher> matcher = make_lcs();
  EXPECT_THROW(matcher->prepare({{"dot", "", {{{1, 1}, {1, 1}, {1, 1}}, {}, {}}}}), InputError);
}

TEST(LocalAlignment, FindsAPlantedStretchAcrossBothEnds) {
  Random random(5);
  std::vector<std::vector<float>> changes(2);
  for (std::vector<float>& border : changes)
    for (int i = 0; i < 150; ++i) border.push_back(static_cast<float>(random.uniform(-4.0, 4.0)));
  for (std::size_t k = 0; k < 40; ++k) changes[1][(140 + k) % 150] = changes[0][(125 + k) % 150];
  const detail::TurnModel model(changes, 0.3);
  std::vector<std::uint8_t> levels[2];
  for (int n = 0; n < 2; ++n)
    for (const float change : changes[static_cast<std::size_t>(n)])
      levels[n].push_back(static_cast<std::uint8_t>(detail::TurnModel::level(change)));
  const std::vector<detail::LocalMatch> found = detail::local_alignments(levels[0], levels[1], model, {});
  ASSERT_FALSE(found.empty());
  std::size_t planted = 0;
  for (const auto& [i, j] : found[0].pairs) planted += (i + 150 - 125) % 150 == (j + 150 - 140) % 150 ? 1 : 0;
  EXPECT_GE(planted, 38U);
  EXPECT_LE(found[0].pairs.size(), 50U);
  for (std::size_t k = 1; k < found.size(); ++k) EXPECT_LT(found[k].score, found[0].score);
}

TEST(TurnModel, LikeBesideLikeSpeaksForAJoinAndMoreSoIfItIsRare) {
  std::vector<std::vector<float>> changes(1, std::vector<float>(1000, 0.0F));
  for (std::size_t i = 0; i < 100; ++i) changes[0][i] = 0.05F * static_cast<float>(i);
  const detail::TurnModel model(changes, 0.3);
  const auto score = [&](float a, float b) {
    return model.score(detail::TurnModel::level(a), detail::TurnModel::level(b));
  };
  EXPECT_GT(score(4.0F, 4.0F), score(0.0F, 0.0F));
  EXPECT_LT(score(4.0F, -4.0F), 0);
  EXPECT_LT(score(0.0F, 4.0F), 0);
  EXPECT_LT(std::abs(score(0.0F, 0.0F)), score(4.0F, 4.0F) / 2);
}

}  // namespace
}  // namespace rejoin::outline
