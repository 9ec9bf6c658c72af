#include "outline/common_subsequence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"

namespace rejoin::outline {
namespace {

/// The textbook table.
std::size_t plain_length(const std::vector<float>& a, const std::vector<float>& b, float tolerance) {
  std::vector<std::vector<std::size_t>> table(a.size() + 1, std::vector<std::size_t>(b.size() + 1, 0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool match = a[i - 1] >= b[j - 1] - tolerance && a[i - 1] <= b[j - 1] + tolerance;
      table[i][j] = match ? table[i - 1][j - 1] + 1 : std::max(table[i - 1][j], table[i][j - 1]);
    }
  }
  return table[a.size()][b.size()];
}

/// Multiples of 1/8, so that differences are exact and ties with the tolerance are met.
std::vector<float> random_values(std::size_t count, Random& random) {
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(static_cast<float>(random.below(33)) / 8.0F - 2.0F);
  return values;
}

TEST(CommonSubsequence, LengthIsThatOfThePlainTable) {
  Random random(7);
  for (const auto& [n, m] : {std::pair{1, 1}, {5, 0}, {17, 63}, {40, 64}, {64, 65}, {90, 128}, {130, 200}}) {
    const std::vector<float> a = random_values(static_cast<std::size_t>(n), random);
    const std::vector<float> b = random_values(static_cast<std::size_t>(m), random);
    for (const float tolerance : {0.0F, 0.25F, 1.0F})
      EXPECT_EQ(lcs_length(a, b, tolerance), plain_length(a, b, tolerance)) << n << " " << m;
  }
}

TEST(CommonSubsequence, PairsMatchRiseAndAreAsManyAsTheLength) {
  Random random(8);
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<float> a = random_values(20 + random.below(90), random);
    const std::vector<float> b = random_values(20 + random.below(90), random);
    const Pairing pairs = lcs(a, b, 0.25F);
    EXPECT_EQ(pairs.size(), plain_length(a, b, 0.25F));
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      EXPECT_LE(std::abs(a[pairs[k].first] - b[pairs[k].second]), 0.25F);
      if (k == 0) continue;
      EXPECT_LT(pairs[k - 1].first, pairs[k].first);
      EXPECT_LT(pairs[k - 1].second, pairs[k].second);
    }
  }
}

TEST(CommonSubsequence, OrdersAreThoseOfThePapersFigures) {
  const std::vector<float> turns{90.0F, -30.0F};
  EXPECT_EQ(in_order(turns, Order::Same), turns);
  EXPECT_EQ(in_order(turns, Order::Reversed), (std::vector<float>{-30.0F, 90.0F}));
  EXPECT_EQ(in_order(turns, Order::Negated), (std::vector<float>{-90.0F, 30.0F}));
  EXPECT_EQ(in_order(turns, Order::ReversedNegated), (std::vector<float>{30.0F, -90.0F}));
}

TEST(CommonSubsequence, FindsAPlantedStretchInEveryOrderWhereverTheSequencesBegin) {
  constexpr std::size_t kSize = 200;
  constexpr std::size_t kStretch = 70;
  for (const Order order : kOrders) {
    for (const std::size_t begin_a : {10, 90, 170}) {
      for (const std::size_t begin_b : {30, 110, 180}) {
        Random random(begin_a + 1000 * begin_b);
        std::vector<float> a;
        std::vector<float> b;
        for (std::size_t i = 0; i < kSize; ++i) {
          a.push_back(static_cast<float>(random.uniform(-4.0, 4.0)));
          b.push_back(static_cast<float>(random.uniform(-4.0, 4.0)));
        }
        std::vector<float> ordered = in_order(b, order);
        for (std::size_t k = 0; k < kStretch; ++k)
          ordered[(begin_b + k) % kSize] =
              a[(begin_a + k) % kSize] + static_cast<float>(random.uniform(-0.1, 0.1));
        b = in_order(ordered, order);  // each order is its own inverse
        const CyclicMatch match = cyclic_lcs(a, b, 0.1F);
        EXPECT_EQ(match.order, order);
        std::size_t planted = 0;
        for (const auto& [i, j] : match.pairs) {
          const std::size_t k = (i + kSize - begin_a) % kSize;
          const bool back = order == Order::Reversed || order == Order::ReversedNegated;
          const std::size_t in_order_j = back ? kSize - 1 - j : j;
          if (k < kStretch && (in_order_j + kSize - begin_b) % kSize == k) ++planted;
        }
        EXPECT_GE(planted, kStretch * 9 / 10);
        const std::size_t centre = (match.pairs[match.centre].first + kSize - begin_a) % kSize;
        EXPECT_LT(centre, kStretch);
      }
    }
  }
}

TEST(CommonSubsequence, OfNothingIsNothing) {
  const std::vector<float> none;
  const std::vector<float> one{1.0F};
  EXPECT_EQ(lcs_length(none, one, 1.0F), 0U);
  EXPECT_TRUE(lcs(one, none, 1.0F).empty());
  EXPECT_TRUE(cyclic_lcs(none, none, 1.0F).pairs.empty());
}

}  // namespace
}  // namespace rejoin::outline
