#include "core/random.hpp"

#include <gtest/gtest.h>

namespace rejoin {
namespace {

TEST(Random, FirstNumbersArePcg32s) {
  // Reference output of O'Neill's pcg32-demo: seed 42, stream 54.
  Random random(42, 54);
  EXPECT_EQ(random.next(), 0xa15c02b7U);
  EXPECT_EQ(random.next(), 0x7b47f409U);
  EXPECT_EQ(random.next(), 0xba1d3330U);
}

TEST(Random, StreamsDiffer) {
  Random a(1, 0);
  Random b(1, 1);
  int same = 0;
  for (int i = 0; i < 1000; ++i) same += a.next() == b.next() ? 1 : 0;
  EXPECT_LE(same, 1);
}

TEST(Random, BelowStaysInRangeAndReachesBothEnds) {
  Random random(3);
  int low = 0;
  int high = 0;
  for (int i = 0; i < 10000; ++i) {
    const auto value = random.below(7);
    ASSERT_LT(value, 7U);
    low += value == 0 ? 1 : 0;
    high += value == 6 ? 1 : 0;
  }
  EXPECT_GT(low, 1000);
  EXPECT_GT(high, 1000);
}

}  // namespace
}  // namespace rejoin
