#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "report/canvas.hpp"
#include "report/outline_pictures.hpp"

namespace rejoin::report {
namespace {

outline::Piece rectangle(const char* name, double width, double height) {
  return {name, "", {{{0, 0}, {width, 0}, {width, height}, {0, height}}, {}, {}}};
}

/// The small piece lies with its side of 60, the first of its border, on the large one's last but one.
outline::JoinCandidate upright() {
  outline::JoinCandidate join;
  join.pose.translation = {100.0, 200.0};
  join.score = 0.009;
  join.boundary = {640.0, 60.0, 60.0};
  return join;
}

/// match.png of a piece of 300 x 200 and one of 60 x 80 that meet along 60.
cv::Mat drawn(const std::string& verdict, const outline::JoinCandidate& best = upright(),
              const outline::Piece& large = rectangle("large", 300, 200)) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("rejoin-outline-match-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  write_outline_match_pictures(folder, large, rectangle("small", 60, 80), {{best}}, verdict);
  cv::Mat image = cv::imread((folder / "match.png").string());
  std::filesystem::remove_all(folder);
  return image;
}

/// Columns of a panel in which a colour (blue, green, red) is found.
int width_of(const cv::Mat& image, int panel, const cv::Vec3b& colour) {
  int columns = 0;
  for (int x = 420 * panel; x < 420 * (panel + 1); ++x) {
    bool found = false;
    for (int y = 56; y < 56 + 420; ++y) found = found || image.at<cv::Vec3b>(y, x) == colour;
    columns += found ? 1 : 0;
  }
  return columns;
}

TEST(OutlineMatchPictures, BothPiecesAreDrawnAtOneScale) {
  const cv::Mat image = drawn("no join");
  const int large = width_of(image, 0, {178, 205, 226});
  const int small = width_of(image, 1, {226, 203, 178});
  EXPECT_GT(large, 300);
  EXPECT_NEAR(small, large / 5.0, 5.0);  // the edges' lines
}

TEST(OutlineMatchPictures, TheBoundaryOfAPieceUpsideDownIsMarkedWhereItIs) {
  outline::JoinCandidate turned_over = upright();
  turned_over.pose = {3.14159265358979, {160.0, 200.0}, true};
  turned_over.boundary.begin_b = 0.0;  // the side's other end
  const cv::Vec3b mark{178, 92, 40};
  const int marked = width_of(drawn("join"), 1, mark);
  EXPECT_GT(marked, 60);
  EXPECT_NEAR(width_of(drawn("join", turned_over), 1, mark), marked, 2);
}

TEST(OutlineMatchPictures, TheBoundaryOfAHoleIsMarkedAroundIt) {
  outline::Piece holed = rectangle("holed", 300, 200);
  holed.outline.holes = {{{100, 50}, {100, 110}, {160, 110}, {160, 50}}};
  outline::JoinCandidate filled = upright();
  filled.boundary = {0.0, 0.0, 240.0, 1, 0};
  // The panel's 368 pixels show 300 units, and the line is 3 wide.
  EXPECT_NEAR(width_of(drawn("join", filled, holed), 0, {44, 44, 206}), 60.0 * 368.0 / 300.0 + 3.0, 3.0);
}

TEST(OutlineMatchPictures, MapsAreDrawnWithNorthUp) {
  outline::Piece a = rectangle("a", 200, 200);
  a.outline.points = {{0, 0}, {100, 0}, {60, 100}, {40, 100}};
  const auto top_is_narrow = [&](bool up) {
    a.y_up = up;
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("rejoin-outline-north-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    write_outline_match_pictures(folder, a, a, {{upright()}}, "join");
    const cv::Mat image = cv::imread((folder / "match.png").string());
    std::filesystem::remove_all(folder);
    const auto width = [&](int y) {
      int found = 0;
      for (int x = 0; x < 420; ++x) found += image.at<cv::Vec3b>(y, x) == cv::Vec3b(178, 205, 226) ? 1 : 0;
      return found;
    };
    return width(56 + 60) < width(56 + 360);
  };
  EXPECT_TRUE(top_is_narrow(true));
  EXPECT_FALSE(top_is_narrow(false));
}

TEST(OutlineMatchPictures, TheTitleIsTheVerdict) {
  const cv::Mat image = drawn("no join");
  Image expected(420, 50, kPaper);
  draw_text(expected, 26, 34, "no join, score 0.009: best pose", {15, kInk, Align::Left, true});
  int different = 0;
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 420; ++x) {
      const Colour want = expected.at(x, y);
      different += image.at<cv::Vec3b>(y, 840 + x) == cv::Vec3b(want.b, want.g, want.r) ? 0 : 1;
    }
  }
  EXPECT_EQ(different, 0);
}

}  // namespace
}  // namespace rejoin::report
