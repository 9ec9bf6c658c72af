#include "shatter/chip_count.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rejoin::shatter {
namespace {

TEST(ChipCount, HasItsMeanForFractionsToo) {
  constexpr int kDraws = 20000;
  for (const double mean : {0.0, 0.1, 0.25, 0.5, 1.0, 1.3, 2.75, 3.0}) {
    Random random(5, 1);
    double sum = 0.0;
    double squares = 0.0;
    for (int k = 0; k < kDraws; ++k) {
      const double count = chip_count(mean, random);
      ASSERT_GE(count, 0.0);
      sum += count;
      squares += count * count;
    }
    const double found = sum / kDraws;
    const double deviation = std::sqrt((squares / kDraws - found * found) / kDraws);
    EXPECT_LE(std::abs(found - mean), 5.0 * deviation) << mean;  // five standard errors
  }
}

// Pieces of a seed stay as they are.
TEST(ChipCount, OfWholeAndHalfMeansDrawsOnce) {
  for (const double mean : {0.0, 0.5, 3.0, 4.5}) {
    Random random(7, 12);
    Random plain(7, 12);
    for (int k = 0; k < 1000; ++k)
      ASSERT_EQ(chip_count(mean, random), static_cast<int>(std::floor(plain.uniform(0.0, 2.0 * mean) + 0.5)));
  }
}

}  // namespace
}  // namespace rejoin::shatter
