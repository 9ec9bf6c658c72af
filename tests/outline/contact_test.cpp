#include "outline/contact.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "outline/property_plot.hpp"

namespace rejoin::outline {
namespace {

Outline circle(double radius, int count) {
  Outline outline;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * M_PI * i / count;
    outline.points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return outline;
}

Outline rectangle(glm::dvec2 low, glm::dvec2 high) {
  Outline outline;
  outline.points = {low, {high.x, low.y}, high, {low.x, high.y}};
  return outline;
}

TEST(Contact, StraightBordersBesideACornerSayNoMoreForTheirLength) {
  const auto told = [](double side) {
    Outline corner;
    corner.points = {{0, 0}, {2 * side, 0}, {2 * side, side}, {side, side}, {side, 2 * side}, {0, 2 * side}};
    const Silhouette a(corner, 1.0, 1.0);
    const Silhouette b(rectangle({side, side}, {2 * side, 2 * side}), 1.0, 1.0);
    return measure_contact(a, b, {}, 1.5).information;
  };
  EXPECT_GT(told(100.0), 0.0);
  EXPECT_LE(told(400.0), told(100.0));
}

/// The upper and the lower half of a disc that a smooth wave parts.
std::pair<Outline, Outline> parted_by_a_wave() {
  std::vector<glm::dvec2> wave;
  for (int i = -800; i <= 800; ++i) {
    const double x = 0.25 * i;
    wave.emplace_back(x, 6.0 * std::sin(x / 12.0) + 3.5 * std::cos(x / 20.0));
  }
  std::pair<Outline, Outline> halves;
  auto& [above, below] = halves;
  above.points = wave;
  above.points.insert(above.points.end(), {{200.0, 150.0}, {-200.0, 150.0}});
  below.points.assign(wave.rbegin(), wave.rend());
  below.points.insert(below.points.end(), {{-200.0, -150.0}, {200.0, -150.0}});
  return halves;
}

TEST(Contact, ASmoothBorderSaysNoMoreForItsSamples) {
  const std::pair<Outline, Outline> halves = parted_by_a_wave();
  const auto told = [&](double step) {
    return measure_contact(Silhouette(halves.first, step, 1.0), Silhouette(halves.second, step, 1.0), {},
                           1.5 * step)
        .information;
  };
  EXPECT_GT(told(4.0), 10.0);
  EXPECT_LT(told(0.5), told(4.0));
}

TEST(DistanceField, IsTheDistanceToACircle) {
  const DistanceField field(circle(50, 720), 0.5, 8.0);
  for (const double radius : {43.0, 47.0, 50.0, 52.0, 56.0}) {
    for (int i = 0; i < 12; ++i) {
      const glm::dvec2 p(radius * std::cos(0.5 * i), radius * std::sin(0.5 * i));
      // The polygon lies 0.0005 inside the circle; linear cells err by cell^2 / (8 radius) = 0.0006.
      EXPECT_NEAR(field(p), 50.0 - radius, 0.003);
      const glm::dvec2 inward = field.gradient(p);
      EXPECT_NEAR(glm::dot(inward, -p / radius), 1.0, 0.01);
    }
  }
}

TEST(DistanceField, IsClampedFarFromTheBorder) {
  const DistanceField field(rectangle({0, 0}, {100, 80}), 1.0, 5.0);
  EXPECT_FLOAT_EQ(static_cast<float>(field({50, 40})), 5.0F);
  EXPECT_FLOAT_EQ(static_cast<float>(field({-3000, 40})), -5.0F);
  EXPECT_FLOAT_EQ(static_cast<float>(field({102, 40})), -2.0F);
}

TEST(DistanceField, StridesOverNothingThatItKnows) {
  const DistanceField field(rectangle({0, 0}, {100, 80}), 1.0, 5.0);
  EXPECT_EQ(field.stride({50, 40}, 2.0), 1U);
  EXPECT_GT(field.stride({-200, 40}, 2.0), 80U);
  for (int direction = 0; direction < 16; ++direction) {
    const glm::dvec2 along(std::cos(0.4 * direction), std::sin(0.4 * direction));
    std::size_t next = 0;
    for (std::size_t k = 0; k < 300; ++k) {
      const glm::dvec2 p = glm::dvec2(50, 40) + (300.0 - 2.0 * static_cast<double>(k)) * along;
      if (k == next) {
        next = k + field.stride(p, 2.0);
      } else {
        EXPECT_EQ(field(p), -5.0) << direction << " " << k;
      }
    }
  }
}

TEST(Contact, OfTwoRectanglesIsTheirCommonSide) {
  const Silhouette a(rectangle({0, 0}, {100, 80}), 1.0, 0.0);
  const Silhouette b(rectangle({0, 0}, {60, 50}), 1.0, 0.0);
  const Contact touch = measure_contact(a, b, Planar{0.0, {100.0, 10.0}, false}, 0.75);
  EXPECT_NEAR(touch.length, 50.0, 3.0);  // a step at each end, on either side
  EXPECT_NEAR(touch.rms, 0.0, 0.1);
  EXPECT_NEAR(touch.intrusion, 0.0, 1e-9);
  EXPECT_NEAR(touch.information, 0.0, 1.0) << "straight sides say nothing";
  const Contact deep = measure_contact(a, b, Planar{0.0, {90.0, 10.0}, false}, 0.75);
  EXPECT_GT(deep.intrusion, 60.0);
}

TEST(Contact, APieceOnItselfIntrudesWithItsWholeBorder) {
  const Silhouette a(rectangle({0, 0}, {100, 80}), 1.0, 0.0);
  for (const double off : {0.0, 0.3, -0.3}) {
    const Contact same = measure_contact(a, a, Planar{0.0, {off, 0.0}, false}, 0.75);
    EXPECT_NEAR(same.intrusion, 360.0, 8.0) << off;  // at the corners the field turns
    EXPECT_LT(same.length, 8.0) << off;
  }
}

TEST(Contact, SettlingClosesAGap) {
  const Silhouette a(rectangle({0, 0}, {100, 80}), 1.0, 0.0);
  const Silhouette b(rectangle({0, 0}, {60, 50}), 1.0, 0.0);
  const Planar apart{0.02, {101.5, 10.0}, false};
  const Planar settled = settle(a, b, apart, 3.0, 20);
  EXPECT_NEAR(settled.angle_rad, 0.0, 2e-3);
  EXPECT_NEAR(settled.translation.x, 100.0, 0.1);
}

TEST(Contact, ARunEndsWhereTheBordersPartOnBothSides) {
  const Silhouette a(rectangle({0, 0}, {100, 50}), 1.0, 1.0);  // its upper side: points 150 to 250
  const Silhouette b(rectangle({0, 50}, {100, 90}), 1.0, 1.0);
  for (const auto& [first, last] : {std::pair(110L, 240L), std::pair(160L, 290L), std::pair(190L, 210L)}) {
    const PointRun run = grown_run(a, b, {}, 1.5, {first, last});
    EXPECT_NEAR(static_cast<double>(run.first), 150.0, 3.0) << first;
    EXPECT_NEAR(static_cast<double>(run.last), 250.0, 3.0) << first;
  }
}

TEST(PropertyPlot, OfACircleIsItsCurvature) {
  const PropertyPlot plot(circle(50, 2000), {2.0, 2.0, false});
  // Over two samples either way of 2 units the direction turns by 4 / 50.
  for (const float turn : plot.channels[0]) EXPECT_NEAR(turn, 4.0 / 50.0, 1e-3);
  const PropertyPlot back(circle(50, 2000), {2.0, 2.0, true});
  for (const float turn : back.channels[0]) EXPECT_NEAR(turn, -4.0 / 50.0, 1e-3);
}

TEST(PropertyPlot, FeaturesAreTheCornersOfARectangle) {
  const PropertyPlot plot(rectangle({0, 0}, {100, 80}), {2.0, 1.0, false});
  ASSERT_EQ(plot.features.size(), 4U);
  EXPECT_EQ(plot.features[0], 0U);
  EXPECT_EQ(plot.features[1], 50U);
  EXPECT_EQ(plot.features[2], 90U);
  EXPECT_EQ(plot.features[3], 140U);
}

}  // namespace
}  // namespace rejoin::outline
