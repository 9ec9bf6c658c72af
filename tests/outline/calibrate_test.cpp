#include "outline/calibrate.hpp"

#include <gtest/gtest.h>

#include "shapes.hpp"

namespace rejoin::outline {
namespace {

/// Four broken tiles: eight pieces, four joins.
struct Set {
  std::vector<Piece> pieces;
  std::vector<KnownJoin> joins;
};

Set broken_set() {
  Set set;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto tile =
        testing::broken_tile(300, 120, {0.7 * static_cast<double>(seed), {30, 10}, false}, 40 + seed);
    set.joins.push_back({set.pieces.size(), set.pieces.size() + 1, tile.upper_to_lower});
    set.pieces.push_back({"lower" + std::to_string(seed), "", tile.lower});
    set.pieces.push_back({"upper" + std::to_string(seed), "", tile.upper});
  }
  return set;
}

TEST(Calibrate, SeparatesTrueFromFalseCandidatesOfCleanBreaks) {
  const Set set = broken_set();
  CalibrateOptions options;
  options.scales = 3;
  options.samples = 60;
  const auto levels = calibrate(set.pieces, set.joins, options, Context());
  ASSERT_EQ(levels.size(), 3U);
  for (const CalibratedLevel& l : levels) {
    EXPECT_GE(l.true_candidates, 10U);
    EXPECT_LT(l.mistaken, 0.4)
        << l.step;  // short stretches of a smooth line cannot be told, whatever the line
    EXPECT_GT(l.level.xi, 0.0);
  }
  EXPECT_NEAR(levels[1].step, 2.0 * levels[0].step, 1e-9);
}

TEST(Calibrate, ItsParametersFindTheJoins) {
  const Set set = broken_set();
  CalibrateOptions options;
  options.samples = 60;
  MultiscaleOptions multiscale;
  for (const CalibratedLevel& l : calibrate(set.pieces, set.joins, options, Context()))
    multiscale.levels.push_back(l.level);
  const auto matcher = make_multiscale(multiscale);
  matcher->prepare(set.pieces);
  for (const KnownJoin& join : set.joins) {
    const PairResult result = matcher->match(join.a, join.b, Context());
    ASSERT_FALSE(result.candidates.empty());
    EXPECT_LT(angle_between(result.candidates[0].pose, join.pose), 0.02);
  }
}

TEST(Calibrate, WithoutJoinsTheDefaultsStay) {
  const Set set = broken_set();
  CalibrateOptions options;
  options.scales = 1;
  options.samples = 20;
  const auto levels = calibrate(set.pieces, {}, options, Context());
  EXPECT_EQ(levels[0].level.xi, default_level().xi);
  EXPECT_EQ(levels[0].mistaken, 0.5);
}

}  // namespace
}  // namespace rejoin::outline
