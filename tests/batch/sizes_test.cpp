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

}  // namespace
}  // namespace rejoin::batch
