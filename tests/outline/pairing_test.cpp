#include "outline/detail/pairing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/random.hpp"
#include "outline/detail/diagonals.hpp"

namespace rejoin::outline::detail {
namespace {

Sequence random_sequence(std::size_t count, Random& random) {
  Sequence sequence;
  for (std::size_t i = 0; i < count; ++i) sequence.values.push_back(static_cast<float>(random.normal()));
  sequence.relief.assign(count, 1.0F);
  return sequence;
}

/// Equations (2) to (4) term by term, as printed.
double by_the_book(const Sequences& s, const std::vector<PairedSamples>& path, const ScaleParameters& p) {
  const auto epsilon = [&](std::size_t k) {
    const double d = static_cast<double>(s.a->values[static_cast<std::size_t>(path[k].i)]) -
                     s.b->values[static_cast<std::size_t>(path[k].j)];
    return d * d;
  };
  double d2 = 0.0;
  double z2 = 0.0;
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    const int tau = path[k + 1].i + path[k + 1].j - path[k].i - path[k].j;
    d2 += (epsilon(k) + epsilon(k + 1)) * tau / 4.0;
    z2 += p.zeta * p.zeta / 2.0 * std::abs((path[k + 1].i - path[k].i) - (path[k + 1].j - path[k].j));
  }
  const double m = path.back().i - path.front().i;
  const double n = path.back().j - path.front().j;
  return d2 + z2 - p.xi * p.xi * ((m + n) / 2.0 - p.n_min);
}

TEST(Pairing, DiscriminantIsThePapers) {
  Random random(3);
  const Sequence a = random_sequence(20, random);
  const Sequence b = random_sequence(20, random);
  const ScaleParameters parameters{0.7, 1.3, 2.5};
  const std::vector<PairedSamples> path{{1, 2}, {2, 3}, {3, 3}, {4, 4}, {4, 5}, {5, 6}};
  EXPECT_NEAR(discriminant({&a, &b}, path, parameters), by_the_book({&a, &b}, path, parameters), 1e-12);
}

TEST(Pairing, SamplesWithoutReliefGainNothing) {
  Sequence flat;
  flat.values.assign(30, 0.0F);
  flat.relief.assign(30, 0.0F);
  const std::vector<PairedSamples> path{{0, 0}, {1, 1}, {2, 2}};
  EXPECT_DOUBLE_EQ(discriminant({&flat, &flat}, path, {1.0, 1.0, 2.0}), 2.0);
  EXPECT_TRUE(initial_candidates({&flat, &flat}, {1.0, 1.0, 2.0}, 3, 10).empty());
}

/// One diagonal after the other, sample by sample.
std::vector<Stretch> stretches_one_by_one(const Sequence& a, const Sequence& b, const StretchRule& rule) {
  const auto size_a = static_cast<int>(a.values.size());
  const auto size_b = static_cast<int>(b.values.size());
  const int count = size_a + std::min(size_a, size_b);
  const auto xi2 = static_cast<float>(rule.xi2);
  const auto drop = static_cast<float>(6.0 * rule.xi2);
  std::vector<Stretch> found;
  for (int first = 0; first < size_b; ++first) {
    Stretch stretch{0, first, 0, 0.0};
    float gain = 0.0F;
    float best = 0.0F;
    const auto end_stretch = [&](int next) {
      if (stretch.length >= rule.least && best > rule.least_gain) {
        stretch.length = std::min({stretch.length, size_a, size_b});
        stretch.gain = best;
        found.push_back(stretch);
      }
      stretch = {next, first + next, 0, 0.0};
      gain = best = 0.0F;
    };
    bool open = true;
    for (int t = 0; t < count && open; ++t) {
      const auto i = static_cast<std::size_t>(t % size_a);
      const auto j = static_cast<std::size_t>((first + t) % size_b);
      const float d = a.values[i] - b.values[j];
      gain += xi2 * a.relief[i] * b.relief[j] - d * d;
      if (gain > best) {
        best = gain;
        stretch.length = t + 1 - stretch.i;
      } else if (gain <= 0.0F || gain < best - drop) {
        end_stretch(t + 1);
        open = t < size_a;
      }
    }
    if (open) end_stretch(count);
  }
  return found;
}

TEST(Diagonals, SeveralAtATimeAreAsOneByOne) {
  Random random(9);
  const auto in_order = [](std::vector<Stretch> list) {
    std::sort(list.begin(), list.end(), [](const Stretch& x, const Stretch& y) {
      return std::tie(x.j, x.i, x.length) < std::tie(y.j, y.i, y.length);
    });
    return list;
  };
  std::size_t all = 0;
  for (std::size_t size_a = 5; size_a < 90; size_a += 7) {
    for (std::size_t size_b = 3; size_b < 90; size_b += 5) {
      const Sequence a = random_sequence(size_a, random);
      Sequence b = random_sequence(size_b, random);
      for (float& relief : b.relief) relief = static_cast<float>(random.uniform());
      for (std::size_t k = 0; k < std::min(size_a, size_b) / 2; ++k) b.values[k] = a.values[k];
      const StretchRule rule{1.3, 0.4, 2};
      const auto expected = in_order(stretches_one_by_one(a, b, rule));
      const auto found = in_order(find_stretches({&a, &b}, rule));
      ASSERT_EQ(found.size(), expected.size()) << size_a << " x " << size_b;
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(std::tie(found[k].i, found[k].j, found[k].length, found[k].gain),
                  std::tie(expected[k].i, expected[k].j, expected[k].length, expected[k].gain))
            << size_a << " x " << size_b;
      }
      all += found.size();
    }
  }
  EXPECT_GT(all, 10000U) << "there must be something to compare";
}

/// Least discriminant of all paths between two cells of a small grid, by trying every one.
double best_of_all(const Sequences& s, const ScaleParameters& p, std::vector<PairedSamples>& path, int size) {
  double best = discriminant(s, path, p);
  const PairedSamples at = path.back();
  for (const PairedSamples step : {PairedSamples{1, 1}, PairedSamples{1, 0}, PairedSamples{0, 1}}) {
    if (at.i + step.i >= size || at.j + step.j >= size) continue;
    path.push_back({at.i + step.i, at.j + step.j});
    best = std::min(best, best_of_all(s, p, path, size));
    path.pop_back();
  }
  return best;
}

TEST(Pairing, RefinementFindsTheBestOfAllPairings) {
  constexpr int kSize = 6;
  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const Sequence a = random_sequence(kSize, random);
    const Sequence b = random_sequence(kSize, random);
    const Sequences sequences{&a, &b};
    const ScaleParameters parameters{1.1, 0.9, 1.0};
    double best = 1e300;
    for (int i = 0; i < kSize; ++i) {
      for (int j = 0; j < kSize; ++j) {
        std::vector<PairedSamples> path{{i, j}};
        best = std::min(best, best_of_all(sequences, parameters, path, kSize));
      }
    }
    // A band that covers the square and what wraps around it: paths that stay inside are at least as many.
    const Candidate refined = refine(sequences, parameters, {{0, 0}, {kSize - 1, kSize - 1}}, kSize);
    EXPECT_LE(refined.discriminant, best + 1e-5);
    EXPECT_NEAR(discriminant(sequences, refined.path, parameters), refined.discriminant, 1e-5);
    EXPECT_LE(refine_everywhere(sequences, parameters).discriminant, best + 1e-5);
  }
}

/// Two closed sequences that share a stretch, which crosses the end of both; B has one sample twice in it.
struct Planted {
  Sequence a;
  Sequence b;
};

Planted plant() {
  Random random(9);
  Planted planted{random_sequence(60, random), random_sequence(70, random)};
  for (int t = 0; t < 25; ++t) {
    const auto from = static_cast<std::size_t>((50 + t) % 60);
    const auto to = static_cast<std::size_t>((60 + t + (t > 12 ? 1 : 0)) % 70);
    planted.b.values[to] = planted.a.values[from] + static_cast<float>(0.05 * random.normal());
    if (t == 12) planted.b.values[(to + 1) % 70] = planted.a.values[from];
  }
  return planted;
}

TEST(Pairing, PlantedStretchIsTheBestCandidateAndIsRefinedOverItsStep) {
  const Planted planted = plant();
  const Sequences sequences{&planted.a, &planted.b};
  const ScaleParameters parameters{0.8, 1.0, 3.0};
  std::vector<Candidate> candidates = initial_candidates(sequences, parameters, 6, 5);
  ASSERT_FALSE(candidates.empty());
  const auto& first = candidates[0].path;
  EXPECT_NEAR(static_cast<double>(first.size()), 13.0, 3.0);  // the noise beside it may fit by chance
  EXPECT_TRUE(
      std::is_sorted(candidates.begin(), candidates.end(),
                     [](const Candidate& x, const Candidate& y) { return x.discriminant < y.discriminant; }));
  std::vector<PairedSamples> wide = first;
  wide.insert(wide.begin(), {first.front().i - 16, first.front().j - 16});
  wide.push_back({first.back().i + 16, first.back().j + 16});
  const Candidate refined = refine(sequences, parameters, wide, 3);
  EXPECT_LT(refined.discriminant, 1.5 * candidates[0].discriminant);
  EXPECT_GE(refined.path.size(), 25U);
  const auto asymmetric = std::adjacent_find(
      refined.path.begin(), refined.path.end(),
      [](const PairedSamples& x, const PairedSamples& y) { return x.i == y.i && y.j == x.j + 1; });
  EXPECT_NE(asymmetric, refined.path.end());
}

TEST(Pairing, PartsOfOneCandidateAreMerged) {
  const auto run = [](int i, int j, int length, double delta) {
    Candidate candidate;
    for (int t = 0; t < length; ++t) candidate.path.push_back({i + t, j + t});
    candidate.discriminant = delta;
    return candidate;
  };
  // The third is the first once around A (40 samples) and B (50 samples); the fourth lies on another diagonal.
  std::vector<Candidate> candidates{run(5, 8, 10, -3), run(12, 15, 10, -2), run(45, 57, 10, -1.5),
                                    run(5, 20, 10, -1)};
  prune_and_merge(candidates, 40, 50, 4);
  ASSERT_EQ(candidates.size(), 2U);
  EXPECT_EQ(candidates[0].path.front().i, 5);
  EXPECT_EQ(candidates[0].path.back().i, 21);
  EXPECT_EQ(candidates[1].path.front().j, 20);
  std::vector<Candidate> few{run(0, 0, 5, -1), run(0, 20, 5, -3), run(0, 30, 5, -2)};
  prune_and_merge(few, 40, 50, 2);
  ASSERT_EQ(few.size(), 2U);
  EXPECT_EQ(few[0].discriminant, -3);
}

}  // namespace
}  // namespace rejoin::outline::detail
