/// rejoin match as a whole, on a block cut along a known surface.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "mesh/load.hpp"
#include "planted_files.hpp"

namespace rejoin::cli::testing {
namespace {

using nlohmann::ordered_json;

class MatchCommand : public ::testing::Test, protected PlantedFiles {
 protected:
  /// What a run writes with --json.
  ordered_json result_of(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--json", json});
    const Finished finished = run(arguments);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return ordered_json::parse(read_file(json));
  }

  /// A vector as an option takes it.
  static std::string text(const glm::dvec3& v) {
    return std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z);
  }

  /// The arguments of a search that is quick because it knows the direction of the break.
  std::vector<std::string> quick(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{
        "match", a, b, "--direction-a", text(pair.direction_a), "--direction-b", text(pair.direction_b)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
};

Rigid pose_of(const ordered_json& rows) {
  Rigid pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) pose.rotation[column][row] = rows[row][column];
    pose.translation[row] = rows[row][3];
  }
  return pose;
}

glm::dvec3 position(const ordered_json& xyz) {
  return {xyz[0], xyz[1], xyz[2]};
}

std::vector<std::string> keys(const ordered_json& object) {
  std::vector<std::string> names;
  for (const auto& [name, value] : object.items()) names.push_back(name);
  return names;
}

/// The text without the values that may differ between two runs.
std::string without_seconds(ordered_json result) {
  result["search"].erase("seconds");
  result["search"].erase("stages");
  return result.dump();
}

// The evaluation of real scans calls 5 degrees and 2 % of the diameter (107 mm here) found.
TEST_F(MatchCommand, FindsThePlantedPose) {
  const ordered_json result = result_of({"match", a, b});
  const Rigid pose = pose_of(result["pose"]);
  EXPECT_LT(glm::degrees(angle_between(pose, pair.truth)), 5.0);
  const glm::dvec3 centre = pair.b.origin + mesh::centroid(pair.b);
  EXPECT_LT(glm::distance(pose(centre), pair.truth(centre)), 0.02 * 107);
  EXPECT_NE(result["verdict"], "no join");
}

TEST_F(MatchCommand, WritesTheKeysOfTheSchema) {
  const ordered_json result = result_of(quick({}));
  EXPECT_EQ(result["schema"], "rejoin.match/1");
  EXPECT_EQ(result["a"]["path"], a);
  EXPECT_EQ(keys(result["b"]), (std::vector<std::string>{"path", "faces", "diameter"}));
  EXPECT_EQ(keys(result["error"]), (std::vector<std::string>{"depth", "slope", "raycast", "overlap",
                                                             "contact_area", "gap_median", "penetration"}));
  EXPECT_EQ(result["pose"], result["candidates"][0]["pose"]);
  EXPECT_EQ(result["pose"][3], ordered_json({0.0, 0.0, 0.0, 1.0}));
  for (const char* key : {"evaluations", "seconds", "seed"})
    EXPECT_TRUE(result["search"].contains(key)) << key;
  EXPECT_EQ(keys(result["backend"]), (std::vector<std::string>{"name", "renderer"}));
  EXPECT_TRUE(result.contains("version"));
  double last = 1.0;
  for (const ordered_json& candidate : result["candidates"]) {
    EXPECT_LE(candidate["score"], last);
    last = candidate["score"];
  }
}

TEST_F(MatchCommand, WarnsOfScansInDifferentUnits) {
  mesh::Mesh metres = pair.b;
  metres.origin *= 1e-3;
  for (glm::vec3& vertex : metres.vertices) vertex *= 1e-3F;
  const std::string path = folder / "metres.ply";
  mesh::save(path, metres);
  const Finished finished = run({"match", a, path, "--json", json});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.err.find("same unit?"), std::string::npos) << finished.err;
  const ordered_json warnings = ordered_json::parse(read_file(json))["warnings"];
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].get<std::string>().find(path), std::string::npos) << warnings[0];
  EXPECT_EQ(result_of(quick({}))["warnings"].size(), 0U);
}

TEST_F(MatchCommand, DashIsStdoutForJsonAloneAndNoFile) {
  const Finished finished = run(quick({"--json", "-"}));
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(without_seconds(ordered_json::parse(finished.out)), without_seconds(result_of(quick({}))));
  EXPECT_FALSE(std::filesystem::exists("-"));
}

TEST_F(MatchCommand, TellsTheTimeOfEveryStage) {
  const ordered_json search = result_of(quick({}))["search"];
  std::vector<std::string> names;
  double sum = 0.0;
  for (const ordered_json& stage : search["stages"]) {
    names.push_back(stage["stage"]);
    EXPECT_GE(stage["seconds"], 0.0) << names.back();
    sum += stage["seconds"].get<double>();
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"load a", "surface a", "coarse a", "facets a", "load b", "surface b",
                                      "coarse b", "facets b", "prepare", "search", "align", "verify"}));
  EXPECT_GT(sum, 0.0);
  EXPECT_LE(sum, search["seconds"].get<double>());
}

TEST_F(MatchCommand, GivesTheSameBytesForAnyNumberOfThreadsAndAgain) {
  const std::string one = without_seconds(result_of(quick({"--threads", "1", "--seed", "5"})));
  EXPECT_EQ(one, without_seconds(result_of(quick({"--threads", "2", "--seed", "5"}))));
  EXPECT_EQ(one, without_seconds(result_of(quick({"--threads", "1", "--seed", "5"}))));
}

TEST_F(MatchCommand, KeepsResultsOnStdoutAndNothingOnStderrInAPipe) {
  const Finished finished = run(quick({}));
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_NE(finished.out.find("score"), std::string::npos);
  EXPECT_EQ(finished.err, "");
}

TEST_F(MatchCommand, QuietSaysNothing) {
  const Finished finished = run(quick({"--quiet"}));
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.out, "");
  EXPECT_EQ(finished.err, "");
}

TEST_F(MatchCommand, VerboseTellsStageTimesOnStderr) {
  const Finished finished = run(quick({"--verbose"}));
  for (const char* word : {"facets a", "load b", "search", "verify", "evaluations"}) {
    EXPECT_NE(finished.err.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(finished.out.find("evaluations"), std::string::npos);
}

TEST_F(MatchCommand, OutHoldsTheModelsAndThePictures) {
  const Finished finished = run(quick({"--out", folder / "deep/result"}));
  EXPECT_EQ(finished.exit_code, 0);
  for (const char* name : {"joined.glb", "joined.ply", "match.png", "depth_a.png", "depth_b.png",
                           "depth_difference.png", "convergence.svg"}) {
    EXPECT_FALSE(read_file(folder / ("deep/result/" + std::string(name))).empty()) << name;
    EXPECT_NE(finished.out.find(name), std::string::npos) << name;
  }
}

TEST_F(MatchCommand, FacetsTellTheNoiseOfAScan) {
  const auto outcome = run({"facets", b, "--json", json});
  ASSERT_EQ(outcome.exit_code, 0);
  const ordered_json found = ordered_json::parse(read_file(json));
  EXPECT_GT(found["noise"], 0.0);
  EXPECT_LT(found["noise"], 0.001 * found["diameter"].get<double>());
  EXPECT_NE(outcome.out.find("noise "), std::string::npos);
}

// Painting every fracture facet of B but the joining one grey leaves one facet, and the same pose.
TEST_F(MatchCommand, PaintedFacetsAreTheOnesThatMayJoin) {
  const std::string paint = folder / "paint.ply";
  ASSERT_EQ(run({"facets", b, "--ply", paint, "--json", json}).exit_code, 0);
  const ordered_json found = ordered_json::parse(read_file(json))["facets"];
  ASSERT_GT(found.size(), 1U);
  const int joining = result_of({"match", a, b})["candidates"][0]["facet_b"];

  mesh::Mesh painted = mesh::load(paint, mesh::Weld::PlacesAndColours).mesh;
  const glm::dvec3 centre = position(found[joining]["centre"]);
  double nearest = 1e300;
  glm::u8vec3 kept(0);
  for (std::size_t v = 0; v < painted.vertices.size(); ++v) {
    const double distance = glm::distance(painted.origin + glm::dvec3(painted.vertices[v]), centre);
    if (distance >= nearest) continue;
    nearest = distance;
    kept = painted.colours[v];
  }
  for (glm::u8vec3& colour : painted.colours) {
    if (colour != kept) colour = glm::u8vec3(190);
  }
  mesh::save(paint, painted);

  ASSERT_EQ(run({"facets", b, "--facets", paint, "--json", json}).exit_code, 0);
  const ordered_json repainted = ordered_json::parse(read_file(json))["facets"];
  int fracture = 0;
  for (const auto& facet : repainted) fracture += facet["fracture"] ? 1 : 0;
  EXPECT_EQ(fracture, 1);
  EXPECT_NEAR(repainted[0]["area"], found[joining]["area"], 0.15 * found[joining]["area"].get<double>());
  const ordered_json result = result_of({"match", a, b, "--facets", paint});
  EXPECT_EQ(result["candidates"][0]["facet_b"], 0);
  EXPECT_LT(glm::degrees(angle_between(pose_of(result["pose"]), pair.truth)), 5.0);
}

TEST_F(MatchCommand, PaintThatLiesOnNeitherScanIsRefusedByName) {
  const std::string paint = folder / "paint.ply";
  mesh::Mesh moved = pair.b;
  moved.origin += glm::dvec3(1000, 0, 0);
  moved.colours.assign(moved.vertices.size(), {250, 20, 20});
  mesh::save(paint, moved);
  const Finished finished = run({"match", a, b, "--facets", paint});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
  EXPECT_NE(finished.err.find(paint), std::string::npos) << finished.err;
  const Finished without_colours = run({"match", a, b, "--facets", a});
  EXPECT_EQ(without_colours.exit_code, 1);
  EXPECT_NE(without_colours.err.find("colours"), std::string::npos) << without_colours.err;
}

// The planted cut is bumpy in both directions: it holds its pose, and half of it says the same as the other half.
TEST_F(MatchCommand, StabilityOfTheTruePoseIsTold) {
  const ordered_json stability = result_of({"match", a, b})["stability"];
  EXPECT_GT(stability["margin"], 0.0);
  EXPECT_LT(stability["repeat_deg"], 1.0);
  EXPECT_LT(stability["repeat_shift"], 0.005 * 107);
  EXPECT_LT(stability["slide"], 0.5);
}

TEST_F(MatchCommand, FacetThatIsNotThereIsWrongUse) {
  const Finished finished = run({"match", a, b, "--facets-b", "0,999"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
  EXPECT_NE(finished.err.find("999"), std::string::npos);
}

// A library that is not there stands for a machine without EGL.
TEST_F(MatchCommand, MissingBackendIsOneLineAndExitsWithOne) {
  const Finished finished = run({"match", a, b, "--backend", "gpu"}, {"REJOIN_EGL_LIBRARY=/nonexistent.so"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_EQ(finished.out, "");
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
  EXPECT_NE(finished.err.find("gpu"), std::string::npos) << finished.err;
}

// The search is made far longer than the time until the signal comes; the limit of CTest ends a run that
// ignores it.
TEST_F(MatchCommand, InterruptWritesWhatWasFoundAndExitsWith130) {
  Running running({"match", a, b, "--json", json, "--verbose", "--search", "esa", "--chains", "256",
                   "--resolution", "512"});
  ASSERT_TRUE(running.wait_for_stderr("b.ply: "));
  running.interrupt();
  const Finished finished = running.finish();
  EXPECT_EQ(finished.exit_code, 130) << finished.err;
  EXPECT_EQ(ordered_json::parse(read_file(json))["search"]["interrupted"], true);
}

// A pipe that nobody writes to holds the program inside the loader; opening our end waits until it is there.
TEST(Interrupt, WhileReadingEndsAtOnceWith130) {
  const TemporaryFolder folder;
  const std::string scan = folder / "endless.ply";
  ASSERT_EQ(mkfifo(scan.c_str(), 0600), 0);
  Running running({"facets", scan});
  const int our_end = open(scan.c_str(), O_WRONLY);
  running.interrupt();
  const Finished finished = running.finish();
  close(our_end);
  EXPECT_EQ(finished.exit_code, 130);
  EXPECT_EQ(finished.out, "");
  EXPECT_NE(finished.err.find("interrupted"), std::string::npos);
}

}  // namespace
}  // namespace rejoin::cli::testing
