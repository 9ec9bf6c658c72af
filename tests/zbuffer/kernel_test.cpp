#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/random.hpp"
#include "zbuffer/detail/slope_sums.hpp"

namespace rejoin::zbuffer::detail {
namespace {

std::vector<float> random_map(int width, int height, double holes, float background, Random& random) {
  std::vector<float> map(static_cast<std::size_t>(width) * height);
  for (float& depth : map)
    depth = random.uniform() < holes ? background : static_cast<float>(random.uniform(10, 20));
  return map;
}

TEST(SlopeSums, VectorsEqualTheScalarLoop) {
  for (const float background :
       {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    for (const int width : {2, 8, 15, 16, 17, 18, 31, 32, 33, 47, 48, 49, 64, 100, 129}) {
      for (const double holes : {0.0, 0.1, 0.6, 1.0}) {
        SCOPED_TRACE(testing::Message()
                     << "width " << width << ", holes " << holes << ", background " << background);
        Random random(static_cast<std::uint64_t>(width));
        const int height = 21;
        const auto a = random_map(width, height, holes, background, random);
        const auto b = random_map(width, height, holes, background, random);
        const SlopeSums fast = slope_sums(a.data(), b.data(), width, height);
        const SlopeSums slow = slope_sums_scalar(a.data(), b.data(), width, height);
        EXPECT_EQ(fast.overlap, slow.overlap);
        EXPECT_EQ(fast.covered_a, slow.covered_a);
        EXPECT_EQ(fast.covered_b, slow.covered_b);
        // A term is rounded by up to 4 half-ulps of 40 = 8e-6 and is 14 in the mean; a lane adds a few dozen.
        EXPECT_NEAR(fast.sum, slow.sum, 1e-6 * slow.sum);
      }
    }
  }
}

TEST(SlopeSums, ReadsNothingOutsideTheMaps) {
  // Exactly sized heap blocks, so that the address sanitizer sees a read beyond them.
  for (int width = 2; width < 40; ++width) {
    const std::vector<float> a(static_cast<std::size_t>(width) * 3, 1.0F);
    const std::vector<float> b(static_cast<std::size_t>(width) * 3, 2.0F);
    EXPECT_EQ(slope_sums(a.data(), b.data(), width, 3).overlap, (width - 1) * 2);
  }
}

}  // namespace
}  // namespace rejoin::zbuffer::detail
