#include <gtest/gtest.h>

#include <string>

#include "../mesh/hung_sheet.hpp"
#include "match/match.hpp"
#include "prepared_pair.hpp"

namespace rejoin::match {
namespace {

using testing::half_block;
using testing::kDegree;
using testing::kHalfX;
using testing::planted_pair;

/// The half below the cut with a sheet that hangs on the edge of the cut and leans to where the other half belongs.
mesh::Mesh half_with_flap() {
  mesh::Mesh half = half_block(true, 48);
  const auto at_edge = [](const glm::vec3& v) {
    return v.x > 0.999F * static_cast<float>(kHalfX) && std::abs(v.y) < 20.0F &&
           std::abs(v.z - static_cast<float>(testing::cut_height(v.x, v.y))) < 1e-3F;
  };
  mesh::test::hang_sheet(half, at_edge, {0, 1, 0},
                         [](float along, float) { return glm::vec3(-0.6F * along, 0.0F, 1.2F * along); });
  return half;
}

TEST(Flap, ThatWouldLieInTheOtherPieceKeepsNoJoinFromBeingFound) {
  const auto planted = planted_pair(5);
  const Context context;
  const Fragment a = prepare("a", testing::moved(half_with_flap(), planted.to_a, {3, -2, 1}), context);
  const Fragment b = prepare("b", planted.b, context);
  ASSERT_FALSE(a.warnings.empty());
  EXPECT_NE(a.warnings.front().find("thin sheet"), std::string::npos) << a.warnings.front();
  const Result result = match(a, b, Options{}, context);
  ASSERT_FALSE(result.candidates.empty());
  const Rigid off = inverse(planted.truth) * result.candidates[0].pose;
  EXPECT_LT(angle_between(off, Rigid{}), 1.0 * kDegree);
  EXPECT_EQ(result.verdict, Verdict::Join);
  EXPECT_GT(result.candidates[0].score, 0.99);
}

}  // namespace
}  // namespace rejoin::match
