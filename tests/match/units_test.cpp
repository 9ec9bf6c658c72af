#include "match/units.hpp"

#include <gtest/gtest.h>

#include <string>

namespace rejoin::match {
namespace {

using Group = std::vector<std::size_t>;

Lengths in_unit(double factor, Lengths scan) {
  return {factor * scan.diameter, factor * scan.spacing, factor * scan.noise, factor * scan.wall};
}

/// As those of a box of pottery, in millimetres: sherds of several sizes, one point spacing, walls of a foot and of a rim.
std::vector<Lengths> sherds() {
  return {
      {120, 0.5, 0.03, 9}, {45, 0.5, 0.02, 6}, {30, 0.4, 0.03, 4.5}, {80, 0.6, 0.03, 5}, {150, 0.5, 0.04, 7}};
}

TEST(Units, CentimetresBesideMillimetresAreTwoGroups) {
  std::vector<Lengths> box = sherds();
  box[1] = in_unit(0.1, box[1]);
  box[4] = in_unit(0.1, box[4]);
  const auto groups = units_apart(box);
  ASSERT_TRUE(groups);
  EXPECT_EQ(groups->small, (Group{1, 4}));
  EXPECT_EQ(groups->large, (Group{0, 2, 3}));
  EXPECT_FALSE(units_apart(sherds()));
}

TEST(Units, SolidPiecesBesideSherdsAreInTheGroupOfTheirUnit) {
  std::vector<Lengths> box = sherds();
  for (const std::size_t solid : {0U, 1U, 2U}) box[solid].wall = 0;
  box[2] = in_unit(0.001, box[2]);
  box[4] = in_unit(0.001, box[4]);
  const auto groups = units_apart(box);
  ASSERT_TRUE(groups);
  EXPECT_EQ(groups->small, (Group{2, 4}));
  EXPECT_EQ(groups->large, (Group{0, 1, 3}));
}

TEST(Units, ScansOfOneObjectInTwoUnitsAreToldByTheirRatio) {
  for (const double ratio : {10.0, 25.4, 39.37, 100.0, 1000.0}) {
    const auto groups = units_apart({sherds()[0], in_unit(1 / ratio, sherds()[0])});
    ASSERT_TRUE(groups) << ratio;
    EXPECT_EQ(groups->small, Group{1}) << ratio;
    EXPECT_NEAR(groups->ratio, ratio, 1e-9 * ratio);
  }
}

TEST(Units, TheSizeOfAPieceHasNoInfluenceOnTheRatio) {
  Lengths large_piece = in_unit(1 / 25.4, sherds()[1]);
  large_piece.diameter *= 2;
  EXPECT_NEAR(units_apart({sherds()[1], large_piece})->ratio, 25.4, 1e-9);
}

TEST(Units, RatiosNameTheUnitsThatTheyFit) {
  const auto named = [](double ratio) {
    const auto units = likely_units(ratio);
    return units ? std::string(units->of_small) + ", " + units->of_large : "";
  };
  EXPECT_EQ(named(9), "centimetres, millimetres");
  EXPECT_EQ(named(23), "inches, millimetres");
  EXPECT_EQ(named(42), "metres, inches");
  EXPECT_EQ(named(110), "metres, centimetres");
  EXPECT_EQ(named(950), "metres, millimetres");
  EXPECT_EQ(named(4.5), "");
  EXPECT_EQ(named(300), "");
}

TEST(Units, LengthsThatDifferOtherwiseThanEachOtherAreOfOtherScanners) {
  EXPECT_FALSE(units_apart({{300, 1.0, 0.1, 0}, {30, 0.02, 0.02, 0}}));  // 10, 50, 5
  EXPECT_FALSE(
      units_apart({{1000, 2.0, 0.2, 40}, {30, 0.05, 0.005, 6}}));  // 33, 40, 40, 7 of a tile beside a cup
}

TEST(Units, SolidPiecesAreKnownBySpacingAndNoise) {
  std::vector<Lengths> box{{120, 0.5, 0.03, 0}, {60, 0.5, 0.02, 0}, {30, 0.4, 0.03, 0}};
  EXPECT_FALSE(units_apart(box));
  box[0] = in_unit(0.1, box[0]);
  const auto groups = units_apart(box);
  ASSERT_TRUE(groups);
  EXPECT_EQ(groups->small, Group{0});
}

TEST(Units, ChipsOfABoxAreInItsUnit) {
  std::vector<Lengths> box = sherds();
  box.push_back({9, 0.5, 0.03, 0.6});  // a flake that the scanner saw as finely as the rest
  EXPECT_FALSE(units_apart(box));
  box.back() = {9, 0.05, 0.003, 5};  // seen more finely, of the same wall
  EXPECT_FALSE(units_apart(box));
  box.back() = {9, 0.05, 0.03, 0.6};  // more points, the same scanner's noise
  EXPECT_FALSE(units_apart(box));
  EXPECT_FALSE(units_apart({{100, 0.5, 0.03, 0}, {9, 0.05, 0.03, 0}}));
}

TEST(Units, InchesBesideCentimetresCannotBeTold) {
  std::vector<Lengths> box = sherds();
  box[1] = in_unit(1 / 2.54, box[1]);
  EXPECT_FALSE(units_apart(box));
}

TEST(Units, WhatIsNotKnownSaysNothing) {
  EXPECT_FALSE(units_apart({}));
  EXPECT_FALSE(units_apart({{100, 0, 0, 0}, {10, 0, 0, 0}}));
  EXPECT_FALSE(units_apart({{100, 0.5, 0.03, 6}, {10, 0.05, 0.003, 0}}));  // one is no sherd
}

}  // namespace
}  // namespace rejoin::match
