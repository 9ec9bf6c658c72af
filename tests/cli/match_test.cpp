/// rejoin match as a whole, on a block cut along a known surface.
#include <fcntl.h>
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "mesh/load.hpp"
#include "planted_match.hpp"

namespace rejoin::cli::testing {
namespace {

using nlohmann::ordered_json;
using MatchCommand = MatchOfPlanted;

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

// The evaluation of real scans calls 5 degrees and 2 % of the diameter (107 mm here) found.
TEST_F(MatchCommand, FindsThePlantedPose) {
  const ordered_json result = result_of({"match", a, b});
  const Rigid pose = pose_of(result["pose"]);
  EXPECT_LT(glm::degrees(angle_between(pose, pair.truth)), 5.0);
  const glm::dvec3 centre = pair.b.origin + mesh::centroid(pair.b);
  EXPECT_LT(glm::distance(pose(centre), pair.truth(centre)), 0.02 * 107);
  EXPECT_NE(result["verdict"], "no join");
  EXPECT_TRUE(result["search"]["near"].is_null());
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

TEST_F(MatchCommand, FacetsTellTheNoiseOfAScanAndTheVersion) {
  const auto outcome = run({"facets", b, "--json", json});
  ASSERT_EQ(outcome.exit_code, 0);
  const ordered_json found = ordered_json::parse(read_file(json));
  EXPECT_TRUE(found.contains("version"));
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

TEST_F(MatchCommand, PaintWithoutABreakAndTwoPaintsOfOneScanAreRefused) {
  const std::string paint = folder / "paint.ply";
  ASSERT_EQ(run({"facets", b, "--ply", paint}).exit_code, 0);
  const Finished twice = run({"match", a, b, "--facets", paint, "--facets", paint});
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_NE(twice.err.find("lies on the same scan as"), std::string::npos) << twice.err;
  mesh::Mesh grey = mesh::load(paint, mesh::Weld::PlacesAndColours).mesh;
  grey.colours.assign(grey.vertices.size(), glm::u8vec3(190));
  mesh::save(paint, grey);
  const Finished finished = run({"match", a, b, "--facets", paint});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.err.find("paint.ply: has no break painted"), std::string::npos) << finished.err;
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

// Sixteen numbers, as CloudCompare shows them, and the JSON of an earlier match are the same pose.
TEST_F(MatchCommand, LooksNearARoughPoseGivenAsNumbersOrAsJson) {
  std::string rows;
  ordered_json matrix = ordered_json::array();
  for (int row = 0; row < 3; ++row) {
    const glm::dmat3& turn = pair.truth.rotation;
    const double shift = pair.truth.translation[row] + 1.0;
    rows +=
        fmt::format("{:.17g} {:.17g}\t{:.17g} {:.17g}\r\n", turn[0][row], turn[1][row], turn[2][row], shift);
    matrix.push_back({turn[0][row], turn[1][row], turn[2][row], shift});
  }
  matrix.push_back({0, 0, 0, 1});
  write_file(folder / "rough.txt", rows + "0 0 0 1\n");
  write_file(folder / "rough.json", ordered_json({{"pose", matrix}}).dump());
  const ordered_json by_numbers = result_of({"match", a, b, "--near", folder / "rough.txt"});
  const ordered_json by_json = result_of({"match", a, b, "--near", folder / "rough.json"});
  EXPECT_EQ(by_numbers["verdict"], "join");
  EXPECT_EQ(by_numbers["pose"], by_json["pose"]);
  EXPECT_EQ(by_numbers["search"]["near"], by_json["search"]["near"]);
}

TEST_F(MatchCommand, ARoughPoseThatIsNoneOrHasNoUseIsRefused) {
  write_file(folder / "rough.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1\n");
  const Finished seventeen = run({"match", a, b, "--near", folder / "rough.txt"});
  EXPECT_EQ(seventeen.exit_code, 1);
  EXPECT_NE(seventeen.err.find("rough.txt"), std::string::npos) << seventeen.err;
  EXPECT_NE(seventeen.err.find("four rows of four numbers"), std::string::npos) << seventeen.err;
  write_file(folder / "rough.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_EQ(run({"match", a, b, "--near", folder / "rough.txt", "--search", "esa"}).exit_code, 2);
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
TEST_F(MatchCommand, InterruptWritesWhatWasFoundAsUnfinishedAndKeepsWhatIsThere) {
  const std::vector<std::string> endless{"match",    a,     b,          "--json", json,           "--verbose",
                                         "--search", "esa", "--chains", "256",    "--resolution", "512"};
  const auto interrupted = [](const std::vector<std::string>& arguments) {
    Running running(arguments);
    EXPECT_TRUE(running.wait_for_stderr("b.ply: "));
    running.interrupt();
    return running.finish();
  };
  const Finished first = interrupted(endless);
  EXPECT_EQ(first.exit_code, 130) << first.err;
  const ordered_json result = ordered_json::parse(read_file(json));
  EXPECT_EQ(result["search"]["interrupted"], true);
  EXPECT_NE(result["warnings"].dump().find("before the search was finished"), std::string::npos) << result;

  std::filesystem::create_directory(folder / "result");
  const std::string model = folder / "result/joined.glb";
  for (const std::string& earlier : {json, model}) write_file(earlier, "earlier");
  std::vector<std::string> again = endless;
  again.insert(again.end(), {"--out", folder / "result"});
  const Finished second = interrupted(again);
  EXPECT_EQ(second.exit_code, 130) << second.err;
  for (const std::string& earlier : {json, model}) EXPECT_EQ(read_file(earlier), "earlier") << earlier;
  EXPECT_NE(second.err.find(json + " is kept"), std::string::npos) << second.err;
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
