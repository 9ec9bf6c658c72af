/// rejoin compare as a whole.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "planted_files.hpp"

namespace rejoin::cli::testing {
namespace {

using nlohmann::ordered_json;

class CompareCommand : public ::testing::Test, protected PlantedFiles {
 protected:
  /// A pose file; `scale` other than 1 or -1 makes it no rigid motion, -1 a mirror image.
  std::string pose_file(double scale) const {
    ordered_json rows = ordered_json::array();
    for (int row = 0; row < 3; ++row) {
      ordered_json line = ordered_json::array();
      for (int column = 0; column < 3; ++column) line.push_back(scale * pair.truth.rotation[column][row]);
      line.push_back(pair.truth.translation[row]);
      rows.push_back(line);
    }
    rows.push_back({0, 0, 0, 1});
    const std::string path = folder / "pose.json";
    write_file(path, ordered_json({{"pose", rows}}).dump());
    return path;
  }

  void expect_refused(const std::string& pose) const {
    const Finished finished = run({"compare", a, b, "--pose", pose});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
    EXPECT_NE(finished.err.find(pose), std::string::npos) << finished.err;
  }
};

// Both halves have the same cut, sampled alike: at the true pose the slopes cancel but for the pixels' interpolation.
TEST_F(CompareCommand, BothErrorsAreSmallAtThePlantedPoseAndAgree) {
  const Finished finished =
      run({"compare", a, b, "--pose", pose_file(1), "--json", json, "--out", folder / "out", "--steps", "0"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.out.find("slope"), std::string::npos);
  const ordered_json result = ordered_json::parse(read_file(json));
  EXPECT_EQ(result["schema"], "rejoin.compare/1");
  EXPECT_NEAR(result["explained"]["total"].get<double>(), 0.0, 0.05);
  EXPECT_FALSE(read_file(folder / "out/compare.png").empty());
  for (const std::string& file : {json, folder / "out/compare.json", folder / "out/compare.png"})
    EXPECT_NE(finished.out.find("wrote " + file + "\n"), std::string::npos) << finished.out;
}

TEST_F(CompareCommand, InterruptedWritesNoFigures) {
  Running running({"compare", a, b, "--pose", pose_file(1), "--json", json, "--verbose", "--resolution",
                   "2048", "--steps", "3"});
  ASSERT_TRUE(running.wait_for_stderr("b.ply: "));
  running.interrupt();
  const Finished finished = running.finish();
  EXPECT_EQ(finished.exit_code, 130) << finished.err;
  EXPECT_EQ(finished.out, "");
  EXPECT_FALSE(std::filesystem::exists(json));
}

TEST_F(CompareCommand, PosesThatAreNoRigidMotionAreRefused) {
  expect_refused(pose_file(2));
  expect_refused(pose_file(-1));
  expect_refused(folder / "missing.json");
  write_file(folder / "text.json", "Dear diary,\n");
  expect_refused(folder / "text.json");
  write_file(folder / "null.json", "{\"pose\": null}");
  expect_refused(folder / "null.json");
  write_file(folder / "far.json", "[[1, 0, 0, 1e39], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]");
  expect_refused(folder / "far.json");
  const std::string deep = std::string(1000000, '[') + std::string(1000000, ']');
  write_file(folder / "deep.json", R"({"a": 1, "b": 2, "pose": )" + deep + "}");
  expect_refused(folder / "deep.json");
}

}  // namespace
}  // namespace rejoin::cli::testing
