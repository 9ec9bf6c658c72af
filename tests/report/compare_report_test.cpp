#include "report/compare_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "planted.hpp"

namespace rejoin::report {
namespace {

match::Comparison planted_comparison() {
  const Planted pair = planted_pair(20);
  match::CompareOptions options;
  options.resolution = 48;
  options.steps = 1;
  return match::compare(pair.a, pair.b, pair.pose, options, Context{});
}

TEST(CompareReport, JsonHoldsEveryPoseOfTheGrid) {
  const auto json = nlohmann::json::parse(compare_json(planted_comparison(), "a.ply", "b\xFF.ply"));
  EXPECT_EQ(json["schema"], "rejoin.compare/1");
  EXPECT_EQ(json["grid"].size(), 243U);
  EXPECT_EQ(json["pose"]["angles_deg"], nlohmann::json({0.0, 0.0, 0.0}));
  const double total = json["explained"]["total"];
  const double parts =
      static_cast<double>(json["explained"]["drawing"]) + static_cast<double>(json["explained"]["detail"]);
  EXPECT_NEAR(total, parts, 1e-9);
}

TEST(CompareReport, TableFitsAHundredColumns) {
  std::istringstream lines(compare_table(planted_comparison()));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
}

TEST(CompareReport, OnePoseHasNoTableOfPosesAroundIt) {
  match::Comparison comparison = planted_comparison();
  EXPECT_NE(compare_table(comparison).find("over 243 poses around it"), std::string::npos);
  comparison.grid.resize(1);
  const std::string table = compare_table(comparison);
  EXPECT_EQ(table.find("around it"), std::string::npos);
  EXPECT_NE(table.find("from the level of detail"), std::string::npos);
}

TEST(CompareReport, PictureIsDrawnWithoutOverlapToo) {
  const Planted pair = planted_pair(10);
  match::CompareOptions options;
  options.resolution = 16;
  options.steps = 0;
  const Rigid far{pair.pose.rotation, pair.pose.translation + glm::dvec3(50, 0, 0)};
  const match::Comparison comparison = match::compare(pair.a, pair.b, far, options, Context{});
  const Image image = draw_comparison(comparison, "a", "b");
  EXPECT_GT(image.width, 1000);
  EXPECT_NO_THROW(nlohmann::json::parse(compare_json(comparison, "a", "b")));
}

}  // namespace
}  // namespace rejoin::report
