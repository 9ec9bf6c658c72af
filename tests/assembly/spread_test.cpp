#include "assembly/spread.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../match/prepared_pair.hpp"

namespace rejoin::assembly {
namespace {

/// The halves of a block, the upper one lifted by some touching distances.
class Lifted {
 public:
  explicit Lifted(double distances)
      : fragments_{match::prepare("below", match::testing::half_block(true, 48), Context{}),
                   match::prepare("above", match::testing::half_block(false, 48), Context{})},

        lift_(distances * match::contact_tolerance(fragments_[0], fragments_[1], match::Breaks::Fresh)) {
    for (const match::Fragment& fragment : fragments_) pieces_.emplace_back(fragment);
  }

  /// What is left of the lift, of 1.
  double left(Known known) const {
    std::vector<Rigid> poses(2);
    poses[1].translation.z = lift_;
    spread_error(pieces_, {0, 1}, {{0, 1, poses[1], known}}, {}, poses);
    return poses[1].translation.z / lift_;
  }

 private:
  std::vector<match::Fragment> fragments_;
  std::vector<Piece> pieces_;
  double lift_;
};

// A thin piece may be missing between the two.
TEST(Spread, WhatDoesNotTouchIsNotPulledTogetherWhereNobodySearched) {
  const Lifted apart(5.0);
  EXPECT_NEAR(apart.left(Known::Met), 1.0, 0.01);
  EXPECT_LT(apart.left(Known::Asked), 0.1);
  EXPECT_LT(Lifted(1.0).left(Known::Met), 0.1) << "what touches is aligned";
}

TEST(Spread, PointsThatAreLeftOutAreStoodForByOthers) {
  const match::Fragment below = match::prepare("below", match::testing::half_block(true, 48), Context{});
  const match::Fragment above = match::prepare("above", match::testing::half_block(false, 48), Context{});
  const Piece a(below);
  const Piece b(above);
  const auto area = [&](std::size_t most) {
    double sum = 0.0;
    for (const Facing& facing : facing_points(a, b, Rigid{}, 1.0, most)) sum += facing.area_of_b;
    return sum;
  };
  ASSERT_LT(facing_points(a, b, Rigid{}, 1.0, 100).size(), facing_points(a, b, Rigid{}, 1.0, 0).size() / 2);
  EXPECT_NEAR(area(100), area(0), 0.05 * area(0));
}

}  // namespace
}  // namespace rejoin::assembly
