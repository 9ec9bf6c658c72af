#include "report/fragment_colours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <tuple>

namespace rejoin::report {
namespace {

using Joins = std::vector<std::pair<std::size_t, std::size_t>>;

constexpr std::size_t kCount = 48;

/// Each joins the next ones, and those whose number in the list gives nearly the same hue.
Joins loops() {
  Joins joins;
  for (const std::size_t step : {1U, 2U, 13U, 21U})
    for (std::size_t k = 0; k + step < kCount; ++k) joins.emplace_back(k, k + step);
  return joins;
}

/// Of the two most alike that join, bytes.
double least_difference(const std::vector<Colour>& colours, const Joins& joins) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : joins)
    least = std::min(least, glm::distance(glm::dvec3(colours[a]), glm::dvec3(colours[b])));
  return least;
}

TEST(FragmentColours, FragmentsThatJoinAreUnlikeAndNoTwoAreAlike) {
  std::vector<Colour> in_order;
  for (std::size_t k = 0; k < kCount; ++k) in_order.push_back(list_colour(k));
  const std::vector<Colour> colours = fragment_colours(kCount, loops());
  EXPECT_GT(least_difference(colours, loops()), 35.0);
  EXPECT_LT(least_difference(in_order, loops()), 20.0) << "or they show nothing";
  std::set<std::tuple<int, int, int>> different;
  for (const Colour& c : colours) different.emplace(c.x, c.y, c.z);
  EXPECT_EQ(different.size(), kCount);
}

TEST(FragmentColours, OrderOfTheJoinsDoesNotMatter) {
  Joins turned = loops();
  std::ranges::reverse(turned);
  for (auto& [a, b] : turned) std::swap(a, b);
  EXPECT_EQ(fragment_colours(kCount, turned), fragment_colours(kCount, loops()));
}

}  // namespace
}  // namespace rejoin::report
