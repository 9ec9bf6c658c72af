#include "report/similarity_picture.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>

namespace rejoin::report {
namespace {

/// A set in which all pairs of the first ten pieces have a candidate, and pieces 1 and 3 are joined.
struct Drawn {
  explicit Drawn(std::size_t count, const std::string& name = "piece_") {
    std::vector<outline::Piece> pieces(count);
    for (std::size_t i = 0; i < count; ++i) pieces[i].name = name + std::to_string(i) + ".png";
    outline::Assembly assembly;
    assembly.similarity.assign(count, std::vector<double>(count, 0.0));
    for (std::size_t i = 0; i < 10; ++i)
      for (std::size_t j = 0; j < 10; ++j) assembly.similarity[i][j] = i == j ? 0.0 : 50.0;
    outline::AssemblyJoin join;
    join.a = 3;
    join.b = 1;
    join.contact = 100.0;
    assembly.joins = {join};
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("rejoin-similarity-" + std::to_string(getpid()) + ".png");
    write_similarity_picture(path, pieces, assembly);
    image = cv::imread(path.string());
    std::filesystem::remove(path);
  }

  /// Pixels of one colour (blue, green, red) left and right of, or above, the cells.
  int count_of(const cv::Rect& area, const cv::Vec3b& colour) const {
    int found = 0;
    for (int y = area.y; y < area.y + area.height; ++y)
      for (int x = area.x; x < area.x + area.width; ++x) found += image.at<cv::Vec3b>(y, x) == colour ? 1 : 0;
    return found;
  }

  cv::Vec3b cell(int row, int column, int size) const {
    return image.at<cv::Vec3b>(210 + row * size + size / 2, 170 + column * size + size / 2);
  }

  cv::Mat image;
};

const cv::Vec3b kNone(236, 234, 234);

TEST(SimilarityPicture, ShowsCandidatesAboveTheDiagonalAndJoinsAloneBelow) {
  const Drawn drawn(12);
  constexpr int kCell = 40;
  EXPECT_NE(drawn.cell(0, 5, kCell), kNone);
  EXPECT_EQ(drawn.cell(5, 0, kCell), kNone);
  EXPECT_EQ(drawn.cell(0, 11, kCell), kNone);
  EXPECT_EQ(drawn.cell(3, 1, kCell), cv::Vec3b(37, 231, 253)) << "the longest is the scale's brightest";
  EXPECT_EQ(drawn.cell(1, 3, kCell), drawn.cell(0, 5, kCell));
}

TEST(SimilarityPicture, FramesTheJoinInRedAndNoOther) {
  const Drawn drawn(12);
  const cv::Vec3b red(40, 40, 214);
  EXPECT_GT(drawn.count_of({170 + 3 * 40, 210 + 40, 40, 40}, red), 100);
  EXPECT_EQ(drawn.count_of({170 + 4 * 40, 210 + 40, 40, 40}, red), 0);
}

TEST(SimilarityPicture, ShowsNamesOf35LettersWhole) {
  const auto ink = [](const std::string& middle) {
    const Drawn drawn(12, "a find of the year " + middle + " piece ");
    int count = 0;
    for (int y = 400; y < 800; ++y)
      for (int x = 0; x < 350; ++x) count += drawn.image.at<cv::Vec3b>(y, x)[0] < 128 ? 1 : 0;
    return count;
  };
  EXPECT_LT(ink("1111"), ink("8888") - 50);
}

TEST(SimilarityPicture, NamesPiecesOnBothAxesAlsoInLargeSets) {
  for (const std::size_t count : {12U, 400U}) {
    const Drawn drawn(count);
    const cv::Vec3b paper(250, 250, 250);
    EXPECT_LT(drawn.image.cols, 1700) << count;
    const int side = std::min(400, drawn.image.cols - 440);
    EXPECT_LT(drawn.count_of({0, 210, 165, side}, paper), 165 * side - 500) << count;
    EXPECT_LT(drawn.count_of({170, 45, side, 160}, paper), 160 * side - 500) << count;
  }
}

}  // namespace
}  // namespace rejoin::report
