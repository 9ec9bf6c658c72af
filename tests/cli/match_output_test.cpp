/// What rejoin match prints and writes.
#include "planted_match.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <limits>

namespace rejoin::cli::testing {
namespace {

using nlohmann::ordered_json;
using MatchOutput = MatchOfPlanted;

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

TEST_F(MatchOutput, WritesTheKeysOfTheSchema) {
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
  // By rank: beside their scores, as log-odds of no less than those of no strength, contact counts for up to 3.2 nats.
  double last = std::numeric_limits<double>::infinity();
  for (const ordered_json& candidate : result["candidates"]) {
    const double score = candidate["score"];
    const double odds = std::max(-8.0, std::log(score) - std::log1p(-score));
    EXPECT_LE(odds, last + 3.2 / 0.75);
    last = odds;
  }
}

TEST_F(MatchOutput, WarnsOfScansInDifferentUnits) {
  mesh::Mesh metres = pair.b;
  metres.origin *= 1e-3;
  for (glm::vec3& vertex : metres.vertices) vertex *= 1e-3F;
  const std::string path = folder / "metres.ply";
  mesh::save(path, metres);
  const Finished finished = run({"match", a, path, "--json", json});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.err.find("the same unit, not this one in millimetres and the other in metres?"),
            std::string::npos)
      << finished.err;
  const ordered_json warnings = ordered_json::parse(read_file(json))["warnings"];
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].get<std::string>().find(path), std::string::npos) << warnings[0];
  EXPECT_EQ(result_of(quick({}))["warnings"].size(), 0U);
}

TEST_F(MatchOutput, DiskThatIsFullForPicturesLeavesAnEarlierMatchAsItWas) {
  const std::string out = folder / "out";
  std::filesystem::create_directory(out);
  for (const std::string& earlier : {json, out + "/joined.glb", out + "/convergence.svg"})
    write_file(earlier, "earlier");
  std::string command = "bash -c 'ulimit -f 16; exec \"$0\" \"$@\"' " REJOIN_PROGRAM;
  for (const std::string& word : quick({"--json", json, "--out", out})) command += " " + word;
  EXPECT_NE(std::system((command + " > /dev/null 2> " + (folder / "err")).c_str()), 0);
  EXPECT_NE(read_file(folder / "err").find(": cannot be written"), std::string::npos)
      << read_file(folder / "err");
  for (const std::string& earlier : {json, out + "/joined.glb", out + "/convergence.svg"})
    EXPECT_EQ(read_file(earlier), "earlier") << earlier;
  EXPECT_FALSE(std::filesystem::exists(out + "/rejoin.part"));
}

// As behind "| head -1": results are printed before the models are written.
TEST_F(MatchOutput, ReaderThatIsGoneCostsNoFiles) {
  const auto without_reader = [](const std::vector<std::string>& arguments) {
    return Running(arguments, {}, Reader::Nobody).finish();
  };
  const Finished match = without_reader(quick({"--json", json, "--out", folder / "out"}));
  EXPECT_EQ(match.exit_code, 128 + SIGPIPE) << "as of any program whose output could not be read";
  EXPECT_EQ(match.err, "");
  EXPECT_EQ(ordered_json::parse(read_file(json))["verdict"], "join");
  for (const char* name : {"out/match.png", "out/joined.glb", "out/depth_a.png"})
    EXPECT_FALSE(read_file(folder / name).empty()) << name;

  std::filesystem::create_directory(folder / "scans");
  for (const std::string& scan : {a, b}) std::filesystem::copy(scan, folder / "scans");
  const Finished assemble = without_reader({"assemble", folder / "scans", "--out", folder / "all"});
  EXPECT_EQ(assemble.exit_code, 128 + SIGPIPE) << assemble.err;
  for (const char* name : {"all/assembled.png", "all/assembled.glb", "all/run/assembly.json"})
    EXPECT_FALSE(read_file(folder / name).empty()) << name;

  const Finished lines = without_reader({"batch", folder / "scans", "--out", folder / "run", "--json"});
  EXPECT_EQ(lines.exit_code, 128 + SIGPIPE) << lines.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "run/pairs.csv")) << "nobody follows the course, so it ends";
  const Finished page = without_reader(quick({"--json", "-"}));
  EXPECT_EQ(page.exit_code, 128 + SIGPIPE);
  EXPECT_EQ(page.err, "");
}

TEST_F(MatchOutput, DashIsStdoutForJsonAloneAndNoFile) {
  const Finished finished = run(quick({"--json", "-"}));
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(without_seconds(ordered_json::parse(finished.out)), without_seconds(result_of(quick({}))));
  EXPECT_FALSE(std::filesystem::exists("-"));
}

TEST_F(MatchOutput, TellsTheTimeOfEveryStage) {
  const ordered_json search = result_of(quick({}))["search"];
  std::vector<std::string> names;
  double sum = 0.0;
  for (const ordered_json& stage : search["stages"]) {
    names.push_back(stage["stage"]);
    EXPECT_GE(stage["seconds"], 0.0) << names.back();
    sum += stage["seconds"].get<double>();
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"load a", "keep a", "surface a", "flaps a", "pores a", "coarse a",
                                      "facets a", "load b", "keep b", "surface b", "flaps b", "pores b",
                                      "coarse b", "facets b", "prepare", "search", "align", "verify"}));
  EXPECT_GT(sum, 0.0);
  EXPECT_LE(sum, search["seconds"].get<double>());
}

TEST_F(MatchOutput, GivesTheSameBytesForAnyNumberOfThreadsAndAgain) {
  const std::string one = without_seconds(result_of(quick({"--threads", "1", "--seed", "5"})));
  EXPECT_EQ(one, without_seconds(result_of(quick({"--threads", "2", "--seed", "5"}))));
  EXPECT_EQ(one, without_seconds(result_of(quick({"--threads", "1", "--seed", "5"}))));
}

TEST_F(MatchOutput, KeepsResultsOnStdoutAndNothingOnStderrInAPipe) {
  const Finished finished = run(quick({}));
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_NE(finished.out.find("score"), std::string::npos);
  EXPECT_EQ(finished.err, "");
}

TEST_F(MatchOutput, QuietSaysNothing) {
  const Finished finished = run(quick({"--quiet"}));
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.out, "");
  EXPECT_EQ(finished.err, "");
}

TEST_F(MatchOutput, VerboseTellsStageTimesOnStderr) {
  const Finished finished = run(quick({"--verbose"}));
  for (const char* word : {"facets a", "load b", "search", "verify", "evaluations"}) {
    EXPECT_NE(finished.err.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(finished.out.find("evaluations"), std::string::npos);
}

// The planted cut is bumpy in both directions: it holds its pose, and half of it says the same as the other half.
TEST_F(MatchOutput, StabilityOfTheTruePoseIsTold) {
  const ordered_json stability = result_of({"match", a, b})["stability"];
  EXPECT_GT(stability["margin"], 0.0);
  EXPECT_LT(stability["repeat_deg"], 1.0);
  EXPECT_LT(stability["repeat_shift"], 0.005 * 107);
  EXPECT_LT(stability["slide"], 0.5);
}

}  // namespace
}  // namespace rejoin::cli::testing
