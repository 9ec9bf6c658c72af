#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "match/align.hpp"
#include "match/evidence.hpp"
#include "match/match.hpp"
#include "planted_block.hpp"

namespace rejoin::match {
namespace {

constexpr double kChip = 12;  // mm, half of its side

/// How deep a chip lies in the top of a block, mm.
double crater(double x, double y) {
  if (std::max(std::abs(x), std::abs(y)) >= kChip) return 0.0;
  const double bowl = (1 - x * x / (kChip * kChip)) * (1 - y * y / (kChip * kChip));
  const double relief = std::sin(0.9 * x + 0.4 * y) * std::cos(0.7 * y - 0.3) +
                        0.6 * std::sin(1.7 * y + 0.5 * x) + 0.5 * std::sin(1.3 * x);
  return bowl * (6.0 + 0.5 * relief);
}

using Height = std::function<double(double x, double y)>;

/// What lies between two heights over a square about the origin, closed.
mesh::Mesh between(const Height& bottom, const Height& top, double half, std::uint32_t cells) {
  mesh::Mesh solid;
  for (const Height& height : {top, bottom}) {
    for (std::uint32_t j = 0; j <= cells; ++j) {
      for (std::uint32_t i = 0; i <= cells; ++i) {
        const double x = half * (2.0 * i / cells - 1);
        const double y = half * (2.0 * j / cells - 1);
        solid.vertices.emplace_back(x, y, height(x, y));
      }
    }
  }
  const std::uint32_t layer = (cells + 1) * (cells + 1);
  const auto quad = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) {
    solid.faces.emplace_back(p, q, r);
    solid.faces.emplace_back(p, r, s);
  };
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * (cells + 1) + i; };
  const auto wall = [&](std::uint32_t p, std::uint32_t q) { quad(p, p + layer, q + layer, q); };
  for (std::uint32_t j = 0; j < cells; ++j) {
    for (std::uint32_t i = 0; i < cells; ++i) {
      quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      quad(layer + at(i, j), layer + at(i, j + 1), layer + at(i + 1, j + 1), layer + at(i + 1, j));
    }
    wall(at(j, 0), at(j + 1, 0));
    wall(at(cells, j), at(cells, j + 1));
    wall(at(j + 1, cells), at(j, cells));
    wall(at(0, j + 1), at(0, j));
  }
  return solid;
}

TEST(Chip, JoinsABlockFiveTimesAsLarge) {
  const auto level = [](double z) { return [z](double, double) { return z; }; };
  const auto broken = [](double x, double y) { return -crater(x, y); };
  Random random(7);
  const Rigid to_chip = testing::random_rigid(random, 100);
  const Fragment block = prepare("block", between(level(-60), broken, 60, 150), Context{});
  const Fragment chip = prepare(
      "chip", testing::moved(between(broken, level(0), kChip - 0.4, 60), to_chip, {1, 2, -3}), Context{});
  ASSERT_GT(block.facets.samples.spacing, 3 * chip.facets.samples.spacing);
  Options options;
  options.near = inverse(to_chip);
  const Result result = match(block, chip, options, Context{});
  EXPECT_EQ(result.verdict, Verdict::Join);
  ASSERT_FALSE(result.candidates.empty());
  const Rigid off = result.candidates.front().pose * to_chip;
  EXPECT_LT(glm::length(off(glm::dvec3(0, 0, -3)) - glm::dvec3(0, 0, -3)), 0.2);
}

// Two bars broken across: their small breaks have few of the samples of their long sides.
TEST(Chip, ALongBarJoinsAsAShortOneDoes) {
  const auto relief = [](double x, double y) {
    return 0.5 * (std::sin(0.9 * x + 0.4 * y) * std::cos(0.7 * y - 0.3) + 0.6 * std::sin(1.7 * y + 0.5 * x) +
                  0.5 * std::sin(1.3 * x));
  };
  const auto level = [](double z) { return [z](double, double) { return z; }; };
  const auto strength_of = [&](double length) {
    const Fragment lower = prepare("lower", between(level(-length), relief, 8, 40), Context{});
    const Fragment upper = prepare("upper", between(relief, level(length), 8, 40), Context{});
    return strength(Joint(lower, upper).evidence(Rigid{}, 0));
  };
  EXPECT_GT(strength_of(400), 0.3 * strength_of(30));
}

}  // namespace
}  // namespace rejoin::match
