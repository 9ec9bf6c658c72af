/// rejoin outline shatter, and lcs on what it makes.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {

using nlohmann::json;

/// B's coordinates to A's, by the truth; both rigid.
std::array<double, 3> true_turn_and_shift(const json& truth, const std::string& a, const std::string& b) {
  const json& wa = truth["fragments"][a]["to_world"];
  const json& wb = truth["fragments"][b]["to_world"];
  const auto at = [](const json& m, int row, int column) { return m[row][column].get<double>(); };
  const double dx = at(wb, 0, 2) - at(wa, 0, 2);
  const double dy = at(wb, 1, 2) - at(wa, 1, 2);
  return {at(wa, 0, 0) * at(wb, 0, 0) + at(wa, 1, 0) * at(wb, 1, 0), at(wa, 0, 0) * dx + at(wa, 1, 0) * dy,
          at(wa, 0, 1) * dx + at(wa, 1, 1) * dy};
}

TEST(OutlineShatter, MakesPiecesWhoseLongestJoinTheLcsFinds) {
  const TemporaryFolder folder;
  const std::string pieces = folder / "pieces";
  const Finished made =
      run({"outline", "shatter", pieces, "--pieces", "3", "--resolution", "100", "--seed", "3"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.out.find("3 pieces of 1 shape"), std::string::npos) << made.out;
  const json truth = json::parse(read_file(pieces + "/truth.json"));
  EXPECT_EQ(truth["fragments"].size(), 3U);
  json join = truth["joins"][0];
  for (const json& other : truth["joins"])
    if (other[2] > join[2]) join = other;
  const std::string a = join[0];
  const std::string b = join[1];
  const std::string file = folder / "match.json";
  const Finished found =
      run({"outline", "match", pieces + "/" + a, pieces + "/" + b, "--method", "lcs", "--json", file});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const json match = json::parse(read_file(file));
  EXPECT_EQ(match["search"]["method"], "lcs");
  EXPECT_EQ(match["verdict"], "join");
  const auto [cosine, x, y] = true_turn_and_shift(truth, a, b);
  EXPECT_NEAR(match["pose"][0][0].get<double>(), cosine, 0.01);
  EXPECT_NEAR(match["pose"][0][2].get<double>(), x, 2.0);
  EXPECT_NEAR(match["pose"][1][2].get<double>(), y, 2.0);
  EXPECT_NEAR(match["boundary"]["length"].get<double>(), join[2].get<double>(), 0.05 * join[2].get<double>());
}

TEST(OutlineShatter, TheSameSeedGivesTheSameBytes) {
  const TemporaryFolder folder;
  for (const char* name : {"one", "two"}) {
    const Finished made =
        run({"outline", "shatter", folder / name, "--tiles", "1", "--pieces", "3", "--resolution", "40",
             "--format", "png", "--wear", "1", "--noise", "0.2", "--threads", name[0] == 'o' ? "1" : "2"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  for (const char* file : {"truth.json", "piece_000.png", "piece_001.png", "piece_002.png"})
    EXPECT_EQ(read_file(folder / (std::string("one/") + file)),
              read_file(folder / (std::string("two/") + file)));
}

TEST(OutlineShatter, CsvHasYTheWayOfThePictures) {
  const TemporaryFolder folder;
  for (const char* format : {"csv", "png"}) {
    const Finished made = run({"outline", "shatter", folder / format, "--tiles", "1", "--pieces", "3",
                               "--resolution", "100", "--format", format});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  const std::string picture = folder / "png/piece_001.png";
  const Finished same = run({"outline", "match", folder / "csv/piece_000.csv", picture});
  EXPECT_EQ(same.exit_code, 0);
  EXPECT_EQ(same.err.find("mirror"), std::string::npos) << same.err;
  const std::string text = read_file(folder / "csv/piece_000.csv");
  write_file(folder / "map.csv", "x,y" + text.substr(text.find('\n')));
  const Finished mirrored = run({"outline", "match", folder / "map.csv", picture});
  EXPECT_NE(mirrored.err.find("map.csv has y up"), std::string::npos) << mirrored.err;
}

TEST(OutlineShatter, LeavesAFolderWithFilesAlone) {
  const TemporaryFolder folder;
  const std::string pieces = folder / "pieces";
  ASSERT_EQ(run({"outline", "shatter", pieces, "--resolution", "30"}).exit_code, 0);
  const std::string before = read_file(pieces + "/truth.json");
  const Finished again = run({"outline", "shatter", pieces, "--resolution", "30", "--seed", "2"});
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_NE(again.err.find("not empty"), std::string::npos) << again.err;
  EXPECT_EQ(read_file(pieces + "/truth.json"), before);
}

TEST(OutlineShatter, FewerPiecesThanObjectsAreWrongUse) {
  const TemporaryFolder folder;
  const Finished finished = run({"outline", "shatter", folder / "pieces", "--shapes", "3", "--pieces", "2"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_NE(finished.err.find("--pieces"), std::string::npos) << finished.err;
}

}  // namespace
}  // namespace rejoin::cli::testing
