#include "core/components.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace rejoin {
namespace {

TEST(Components, TheSmallestElementStandsForItsSet) {
  Components components(6);
  components.unite(5, 3);
  components.unite(4, 1);
  components.unite(3, 4);
  for (const std::uint32_t i : {1U, 3U, 4U, 5U}) EXPECT_EQ(components.of(i), 1U) << i;
  EXPECT_EQ(components.of(0), 0U);
  EXPECT_EQ(components.of(2), 2U);
}

TEST(Components, AgreesWithRelabellingOfAllElements) {
  constexpr std::uint32_t kCount = 200;
  Random random(3);
  Components components(kCount);
  std::vector<std::uint32_t> label(kCount);
  std::iota(label.begin(), label.end(), 0U);
  for (int step = 0; step < 150; ++step) {
    const std::uint32_t a = random.below(kCount);
    const std::uint32_t b = random.below(kCount);
    components.unite(a, b);
    const auto [low, high] = std::minmax({label[a], label[b]});
    std::replace(label.begin(), label.end(), high, low);
  }
  for (std::uint32_t i = 0; i < kCount; ++i) EXPECT_EQ(components.of(i), label[i]) << i;
}

}  // namespace
}  // namespace rejoin
