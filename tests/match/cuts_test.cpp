#include "match/cuts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "planted_block.hpp"

namespace rejoin::match {
namespace {

const Fragment& half() {
  static const Fragment fragment = prepare("half", testing::half_block(true, 48), Context{});
  return fragment;
}

TEST(Cuts, NumbersGoThroughBoth) {
  const FacetNumbers numbers = facet_numbers(half());
  ASSERT_EQ(numbers.creased, static_cast<int>(half().facets.facets.size()));
  ASSERT_EQ(numbers.end - numbers.creased, static_cast<int>(half().facets.creased.facets.size()));
  ASSERT_GT(numbers.end, numbers.creased);
  EXPECT_EQ(&facet(half(), 0), &half().facets.facets.front());
  EXPECT_EQ(&facet(half(), numbers.creased), &half().facets.creased.facets.front());
  EXPECT_EQ(&facet(half(), numbers.end - 1), &half().facets.creased.facets.back());
}

TEST(Cuts, FacetBetweenCreasesIsSeenAsTheOneThatHoldsMostOfIt) {
  const FacetNumbers numbers = facet_numbers(half());
  for (int f = numbers.creased; f < numbers.end; ++f) {
    std::map<int, std::size_t> held;
    for (std::size_t i = 0; i < half().facets.samples.size(); ++i) {
      const int seen = half().facets.facet_of_sample[i];
      if (half().facets.creased.facet_of_sample[i] == f - numbers.creased && seen >= 0) ++held[seen];
    }
    ASSERT_FALSE(held.empty());
    const std::size_t by_this = held[seen_facet(half(), f)];
    for (const auto& [seen, samples] : held) EXPECT_LE(samples, by_this);
  }
  EXPECT_EQ(seen_facet(half(), 1), 1);
  EXPECT_EQ(seen_facet(half(), -1), -1);
}

TEST(Cuts, AllFacetsThatAUserSeesAreAllFacets) {
  const FacetNumbers numbers = facet_numbers(half());
  std::vector<int> seen(static_cast<std::size_t>(numbers.creased));
  std::iota(seen.begin(), seen.end(), 0);
  std::vector<int> all(static_cast<std::size_t>(numbers.end));
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(in_both_cuts(half(), seen), all);
  for (const int number : in_both_cuts(half(), {2})) EXPECT_EQ(seen_facet(half(), number), 2);
}

}  // namespace
}  // namespace rejoin::match
