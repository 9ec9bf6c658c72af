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

TEST(Sizes, TheFewerOfTwoGroupsTenTimesApartAreNamed) {
  std::vector<store::Fragment> box;
  for (const double unit : {1.0, 0.1, 1.0}) {
    store::Fragment scan = fragment(unit < 1 ? "in_cm" : "in_mm", 100 * unit);
    scan.spacing = 0.5 * unit;
    scan.noise = 0.03 * unit;
    scan.wall = 6 * unit;
    box.push_back(scan);
  }
  box.emplace_back();  // not ready
  const std::string small = told_of_ten_times(box);
  EXPECT_EQ(small.find("in_cm (diameter 10): every length"), 0U) << small;
  EXPECT_NE(small.find("a tenth"), std::string::npos) << small;
  EXPECT_EQ(doubts_about_units(box), std::vector<std::string>{small});

  box.push_back(box[1]);
  box.push_back(box[1]);
  const std::string large = told_of_ten_times(box);
  EXPECT_EQ(large.find("in_mm (diameter 100), in_mm (diameter 100): every length"), 0U) << large;
  EXPECT_NE(large.find("ten times"), std::string::npos) << large;
}

}  // namespace
}  // namespace rejoin::batch
