/// Broken shapes and pictures for rejoin outline.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "run_program.hpp"

namespace rejoin::cli::testing {

using nlohmann::json;
using Matrix = std::array<std::array<double, 3>, 3>;

inline Matrix matrix_of(const json& rows) {
  return rows.get<Matrix>();
}

inline Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) result[i][j] += a[i][k] * b[k][j];
  return result;
}

/// Of a motion.
inline Matrix inverse(const Matrix& m) {
  return {{{m[0][0], m[1][0], -m[0][0] * m[0][2] - m[1][0] * m[1][2]},
           {m[0][1], m[1][1], -m[0][1] * m[0][2] - m[1][1] * m[1][2]},
           {0.0, 0.0, 1.0}}};
}

/// The pieces are some hundred pixels across: a hundredth of a radian moves their ends by a few pixels.
inline void expect_same_motion(const Matrix& found, const Matrix& truth) {
  for (std::size_t row = 0; row < 2; ++row) {
    EXPECT_NEAR(found[row][0], truth[row][0], 0.01);
    EXPECT_NEAR(found[row][1], truth[row][1], 0.01);
    EXPECT_NEAR(found[row][2], truth[row][2], 5.0);
  }
}

/// Two shapes broken into three pieces each.
struct BrokenShapes {
  TemporaryFolder folder;
  std::string pieces = folder / "pieces";
  json truth;

  BrokenShapes() {
    const Finished made = run({"outline", "shatter", pieces, "--shapes", "2", "--pieces", "6", "--resolution",
                               "25", "--seed", "5"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    truth = json::parse(read_file(pieces + "/truth.json"));
  }

  std::string operator/(const std::string& name) const { return folder / name; }

  Matrix world(const std::string& piece) const { return matrix_of(truth["fragments"][piece]["to_world"]); }

  json assembled() const {
    const std::string file = folder / "assembly.json";
    const Finished done = run({"outline", "assemble", pieces, "--json", file});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return json::parse(read_file(file));
  }
};

/// A dark square on white, or what `draw` makes of a white picture.
template <typename Draw>
std::string picture(const TemporaryFolder& folder, const std::string& name, const Draw& draw) {
  cv::Mat image(64, 64, CV_8U, cv::Scalar(255));
  draw(image);
  const std::string path = folder / name;
  EXPECT_TRUE(cv::imwrite(path, image));
  return path;
}

inline std::string good_picture(const TemporaryFolder& folder) {
  return picture(folder, "good.png", [](cv::Mat& image) {
    cv::rectangle(image, cv::Rect(10, 12, 40, 30), cv::Scalar(0), cv::FILLED);
  });
}

/// Refused with exit code 1 and one line that contains `reason`.
inline void expect_refusal(const std::vector<std::string>& arguments, const std::string& reason) {
  const Finished finished = run(arguments);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
  EXPECT_NE(finished.err.find(reason), std::string::npos) << finished.err;
}

}  // namespace rejoin::cli::testing
