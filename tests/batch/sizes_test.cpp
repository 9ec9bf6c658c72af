#include "batch/sizes.hpp"

#include <gtest/gtest.h>

namespace rejoin::batch {
namespace {

store::Fragment fragment(const std::string& name, double diameter) {
  store::Fragment made;
  made.name = name;
  made.diameter = diameter;
  made.state = store::FragmentState::Ready;
  return made;
}

TEST(Sizes, OtherUnitsAreOddAndCrumbsAreNot) {
  std::vector<store::Fragment> box{fragment("a", 120), fragment("crumb", 2), fragment("b", 90),
                                   fragment("metres", 0.1), fragment("micrometres", 1e5)};
  box.emplace_back();  // not ready: has no size
  const OddSizes odd = odd_sizes(box);
  EXPECT_EQ(odd.median, 90);
  ASSERT_EQ(odd.fragments.size(), 2U);
  EXPECT_EQ(odd.fragments[0].name, "metres");
  EXPECT_EQ(odd.fragments[1].name, "micrometres");
  EXPECT_NE(told(odd).find("metres (diameter 0.1), micrometres (diameter 1e+05)"), std::string::npos)
      << told(odd);
}

TEST(Sizes, OneOfTwoIsTold) {
  EXPECT_EQ(odd_sizes({fragment("a", 100), fragment("b", 0.1)}).fragments.size(), 1U);
  EXPECT_EQ(told(odd_sizes({fragment("a", 100), fragment("b", 10)})), "");
  EXPECT_EQ(told(odd_sizes({})), "");
}

/// Scans of equal pieces in units of so many millimetres.
std::vector<store::Fragment> box_of(const std::vector<double>& units) {
  std::vector<store::Fragment> box;
  for (const double unit : units) {
    store::Fragment scan = fragment(unit > 1 ? "other" : "in_mm", 100 / unit);
    scan.spacing = 0.5 / unit;
    scan.noise = 0.03 / unit;
    scan.wall = 6 / unit;
    box.push_back(scan);
  }
  box.emplace_back();  // not ready
  return box;
}

TEST(Sizes, TheFewerOfTwoGroupsOfUnitsAreNamed) {
  const std::string small = told(odd_unit(box_of({1, 10, 1})));
  EXPECT_EQ(small.find("other (diameter 10): every length"), 0U) << small;
  EXPECT_NE(small.find("about 1/10 of those of the others"), std::string::npos) << small;
  EXPECT_NE(small.find("none in centimetres beside millimetres"), std::string::npos) << small;

  const std::string large = told(odd_unit(box_of({1, 25.4, 1, 25.4, 25.4})));
  EXPECT_EQ(large.find("in_mm (diameter 100), in_mm (diameter 100): every length"), 0U) << large;
  EXPECT_NE(large.find("about 25 times those of the others"), std::string::npos) << large;
  EXPECT_NE(large.find("none in millimetres beside inches"), std::string::npos) << large;
}

TEST(Sizes, AScanOfAnOddUnitIsToldOnce) {
  for (const double unit : {10.0, 1000.0}) {
    const std::vector<store::Fragment> box = box_of({1, unit, 1});
    EXPECT_EQ(doubts_about_lengths(box), std::vector<std::string>{told(odd_unit(box))}) << unit;
  }
}

TEST(Sizes, ScansTooCoarseForTheWallsOfTheOthersAreNamed) {
  std::vector<store::Fragment> box = box_of({1, 1, 1});
  store::Fragment coarse = fragment("coarse", 90);
  coarse.spacing = 5;
  store::Fragment fine = coarse;
  fine.name = "solid";
  fine.spacing = 1;
  box.push_back(coarse);
  box.push_back(fine);
  const std::vector<std::string> doubts = doubts_about_lengths(box);
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_EQ(doubts[0].find("coarse (diameter 90): taken for solid among sherds with walls 6 thick"), 0U)
      << doubts[0];
  box.push_back(coarse);  // as many solid pieces as sherds
  EXPECT_TRUE(doubts_about_lengths(box).empty());
}

}  // namespace
}  // namespace rejoin::batch
