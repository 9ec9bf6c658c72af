/// rejoin compare as a whole.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mesh/load.hpp"
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

TEST_F(CompareCommand, TellsWhatMatchTellsOfItsPoseAndLeavesARoughOneWhereItIs) {
  ASSERT_EQ(run({"match", a, b, "--json", folder / "match.json"}).exit_code, 0);
  const ordered_json match = ordered_json::parse(read_file(folder / "match.json"));
  const auto joint_at = [&](const std::string& pose) {
    EXPECT_EQ(run({"compare", a, b, "--pose", pose, "--json", json, "--steps", "0"}).exit_code, 0);
    return ordered_json::parse(read_file(json))["joint"];
  };
  const ordered_json found = joint_at(folder / "match.json");
  for (const char* figure : {"contact_area", "gap_median", "penetration"}) {
    const double told = match["error"][figure];
    EXPECT_NEAR(found[figure].get<double>(), told, 1e-3 * told) << figure;
  }
  EXPECT_GE(found["score"].get<double>(), match["score"].get<double>() - 1e-9);
  // The pose of a match of A and B tells that of B and A as well.
  ASSERT_EQ(run({"compare", b, a, "--pose", folder / "match.json", "--json", json, "--steps", "0"}).exit_code,
            0);
  EXPECT_GT(ordered_json::parse(read_file(json))["joint"]["score"].get<double>(), 0.99);

  ordered_json lifted = match["pose"];
  for (int row = 0; row < 3; ++row)
    lifted[row][3] = lifted[row][3].get<double>() + 4.0 * pair.direction_a[row];
  write_file(folder / "lifted.json", ordered_json({{"pose", lifted}}).dump());
  const ordered_json rough = joint_at(folder / "lifted.json");
  EXPECT_LT(rough["contact_area"].get<double>(), 0.05 * found["contact_area"].get<double>());
  EXPECT_LT(rough["score"].get<double>(), 0.01);
}

TEST_F(CompareCommand, JudgesByPaintedBreaks) {
  const std::string paint = folder / "paint.ply";
  ASSERT_EQ(run({"facets", b, "--ply", paint}).exit_code, 0);
  mesh::Mesh painted = mesh::load(paint, mesh::Weld::PlacesAndColours).mesh;
  for (std::size_t v = 0; v < painted.vertices.size(); ++v) {
    const glm::dvec3 in_block = inverse(pair.to_b)(painted.origin + glm::dvec3(painted.vertices[v]));
    painted.colours[v] =
        in_block.z < 0.7 * match::testing::kHalfZ ? glm::u8vec3(190) : glm::u8vec3(250, 20, 20);
  }
  mesh::save(paint, painted);
  const auto contact = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"compare", a, b, "--pose", pose_file(1), "--json", json, "--steps", "0"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(run(words).exit_code, 0);
    return ordered_json::parse(read_file(json))["joint"]["contact_area"].get<double>();
  };
  EXPECT_GT(contact({}), 1000.0);
  EXPECT_LT(contact({"--facets", paint}), 100.0) << "the back is the break";
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
