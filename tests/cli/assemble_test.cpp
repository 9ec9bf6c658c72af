/// rejoin shatter and rejoin assemble as a whole, on a ball.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "../mesh/shapes.hpp"
#include "mesh/load.hpp"
#include "mesh/save.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {

using nlohmann::ordered_json;

/// A ball broken in three, and its assembly: made once, and only read.
class Ball {
 public:
  static const Ball& once() {
    static const Ball ball;
    return ball;
  }

  std::string mesh() const { return folder_ / "ball.ply"; }
  std::string scans() const { return folder_ / "scans"; }
  std::string assembly() const { return folder_ / "out"; }

 private:
  Ball() {
    mesh::save(mesh(), mesh::test::icosphere(10.0F, 4));
    const Finished broken = run({"shatter", mesh(), "--pieces", "3", "--spacing", "2", "--roughness", "2",
                                 "--chips", "0", "--out", scans()});
    EXPECT_EQ(broken.exit_code, 0) << broken.err;
    const Finished assembled = run({"assemble", scans(), "--out", assembly(), "--quiet"});
    EXPECT_EQ(assembled.exit_code, 0) << assembled.err;
  }

  const TemporaryFolder folder_;
};

/// The pieces of the ball in a folder of its own.
class BrokenBall : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::copy(Ball::once().scans(), scans_, std::filesystem::copy_options::recursive);
  }

  /// Folder of an assembly whose run knows all pairs of the ball.
  std::string matched() const {
    std::filesystem::copy(Ball::once().assembly(), folder_ / "out", std::filesystem::copy_options::recursive);
    return folder_ / "out";
  }

  const TemporaryFolder folder_;
  const std::string scans_ = folder_ / "scans";
  const std::string json_ = folder_ / "assembly.json";
};

TEST_F(BrokenBall, ShatterWritesItsTruth) {
  const ordered_json truth = ordered_json::parse(read_file(scans_ + "/truth.json"));
  EXPECT_EQ(truth["fragments"].size(), 3U);
  EXPECT_GE(truth["joins"].size(), 2U);
  for (const auto& [name, fragment] : truth["fragments"].items()) {
    EXPECT_EQ(mesh::load(scans_ + "/" + name).mesh.faces.size(), fragment["faces"]);
    EXPECT_EQ(fragment["to_world"].size(), 4U);
  }
}

TEST_F(BrokenBall, ShatterRefusesAFolderInUseWhoseFragmentsWouldMixWithItsOwn) {
  const std::string truth = read_file(scans_ + "/truth.json");
  const Finished again = run({"shatter", Ball::once().mesh(), "--pieces", "2", "--out", scans_});
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_NE(again.err.find("not empty"), std::string::npos) << again.err;
  EXPECT_TRUE(is_one_line(again.err)) << again.err;
  EXPECT_EQ(read_file(scans_ + "/truth.json"), truth);
}

TEST_F(BrokenBall, AssembleOfAFolderMatchesAndPutsItTogether) {
  const std::string out = folder_ / "out";
  const Finished finished = run({"assemble", scans_, "--json", json_, "--out", out});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const ordered_json result = ordered_json::parse(read_file(json_));
  EXPECT_EQ(result["schema"], "rejoin.assembly/1");
  ASSERT_EQ(result["fragments"].size(), 3U);
  EXPECT_TRUE(result["unplaced"].empty());
  for (const char* file : {"/assembled.glb", "/assembled.ply", "/assembled.mlp", "/assembled.png",
                           "/cloudcompare/fragment_00.ply.txt", "/run/pairs.csv", "/run/assembly.json"}) {
    EXPECT_TRUE(std::filesystem::exists(out + file)) << file;
  }
  EXPECT_EQ(read_file(out + "/run/assembly.json"), read_file(json_));
  std::istringstream matrix(read_file(out + "/cloudcompare/fragment_01.ply.txt"));
  std::size_t numbers = 0;
  for (double number = 0; matrix >> number; ++numbers)
    EXPECT_EQ(number, result["fragments"]["fragment_01.ply"]["pose"][numbers / 4][numbers % 4])
        << "to the last bit";
  EXPECT_EQ(numbers, 16U);
  // The glb's named nodes carry the transforms; the ply has all fragments' faces.
  std::size_t faces = 0;
  for (const auto& [name, fragment] : result["fragments"].items()) {
    faces += mesh::load(scans_ + "/" + name).mesh.faces.size();
    EXPECT_NE(read_file(out + "/assembled.glb").find(name), std::string::npos);
  }
  EXPECT_EQ(mesh::load(out + "/assembled.ply").mesh.faces.size(), faces);

  // The run that was kept is used again, and pairs that must not join stay apart.
  const std::string wishes = folder_ / "wishes.json";
  write_file(
      wishes,
      R"({"must_not_join": [["fragment_00.ply", "fragment_01.ply"], ["fragment_00.ply", "fragment_02.ply"]]})");
  write_file(out + "/cloudcompare/notes.txt", "mine");
  const Finished again =
      run({"assemble", out + "/run", "--json", json_, "--constraints", wishes, "--out", out});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_FALSE(std::filesystem::exists(out + "/cloudcompare/fragment_00.ply.txt"))
      << "the matrix of a piece that is placed no more";
  EXPECT_TRUE(std::filesystem::exists(out + "/cloudcompare/fragment_01.ply.txt"));
  EXPECT_TRUE(std::filesystem::exists(out + "/cloudcompare/notes.txt"));
  const ordered_json apart = ordered_json::parse(read_file(json_));
  EXPECT_EQ(apart["unplaced"], ordered_json({"fragment_00.ply"}));
  EXPECT_EQ(apart["constraints"]["must_not_join"], ordered_json::parse(read_file(wishes))["must_not_join"]);
  EXPECT_TRUE(apart["fragments"]["fragment_00.ply"]["pose"].is_null());
  EXPECT_FALSE(apart["fragments"]["fragment_00.ply"]["reason"].get<std::string>().empty());
  EXPECT_EQ(read_file(out + "/run/assembly.json"), read_file(json_)) << "the page shows the last assembly";

  // Of nothing there are no models, and that is told.
  ordered_json none = ordered_json::array();
  for (const auto& [a, of_a] : result["fragments"].items()) {
    for (const auto& [b, of_b] : result["fragments"].items()) {
      if (a < b) none.push_back({a, b});
    }
  }
  write_file(wishes, ordered_json({{"must_not_join", none}}).dump());
  const Finished nothing = run({"assemble", out + "/run", "--out", out, "--constraints", wishes});
  EXPECT_EQ(nothing.exit_code, 0) << nothing.err;
  EXPECT_NE(nothing.out.find("nothing is placed"), std::string::npos) << nothing.out;
  for (const char* file : {"/assembled.glb", "/assembled.ply", "/assembled.mlp", "/assembled.png",
                           "/cloudcompare/fragment_01.ply.txt"}) {
    EXPECT_FALSE(std::filesystem::exists(out + file)) << file;
  }
}

/// What lies in a folder, and below it, with its content; but for the database, beside which SQLite keeps files for as long as it reads.
std::map<std::string, std::string> contents_of(const std::string& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().filename().string().find("run.sqlite") != 0)
      contents[entry.path().string()] = read_file(entry.path().string());
  }
  return contents;
}

/// Two assemblies of one run: the second would leave a piece out.
class SecondAssembly : public ::testing::Test {
 protected:
  void SetUp() override {
    copy_the_first();
    write_file(
        wishes_,
        R"({"must_not_join": [["fragment_00.ply", "fragment_01.ply"], ["fragment_00.ply", "fragment_02.ply"]]})");
  }

  void copy_the_first() const {
    std::filesystem::remove_all(out_);
    std::filesystem::copy(Ball::once().assembly(), out_, std::filesystem::copy_options::recursive);
  }

  const TemporaryFolder folder_;
  const std::string out_ = folder_ / "out";
  const std::string run_ = out_ + "/run";
  const std::string wishes_ = folder_ / "wishes.json";
};

TEST_F(SecondAssembly, ThatFindsTheDiskFullLeavesTheFirstAsItWas) {
  const auto models = contents_of(out_);
  const std::string poses = models.at(run_ + "/assembly.json");
  ASSERT_GT(models.at(out_ + "/assembled.glb").size(), 40 * 1024U);
  ASSERT_LT(poses.size(), 40 * 1024U);
  const std::string command =
      "bash -c 'ulimit -f 40; exec \"$0\" assemble \"$1\" --out \"$2\" --constraints \"$3\"' " REJOIN_PROGRAM
      " " +
      run_ + " " + out_ + " " + wishes_ + " > /dev/null 2> " + (folder_ / "err");
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_NE(read_file(folder_ / "err").find("assembled.glb: cannot be written"), std::string::npos)
      << read_file(folder_ / "err");
  EXPECT_TRUE(contents_of(out_) == models) << "and nothing that is half written";
}

TEST_F(SecondAssembly, ThatIsInterruptedWhileModelsAreMadeLeavesTheFirstAsItWas) {
  const auto models = contents_of(out_);
  Finished finished;
  finished.exit_code = 0;
  for (int tries = 0; finished.exit_code == 0 && tries < 50; ++tries) {  // it may be done before it hears
    copy_the_first();
    Running second({"assemble", run_, "--out", out_, "--constraints", wishes_});
    ASSERT_TRUE(second.wait_for_stdout("placed, "));
    second.interrupt();
    finished = second.finish();
  }
  EXPECT_EQ(finished.exit_code, 130) << finished.err;
  EXPECT_NE(finished.err.find("interrupted; what an earlier assembly wrote stays"), std::string::npos)
      << finished.err;
  EXPECT_TRUE(contents_of(out_) == models);
}

TEST_F(SecondAssembly, ThatMayNotWriteIntoTheRunGoesIntoItsOwnFolder) {
  std::filesystem::remove(run_ + "/assembly.json");
  std::filesystem::create_directory(run_ + "/assembly.json");  // refuses as a disk does that may only be read
  EXPECT_EQ(run({"assemble", run_}).exit_code, 1) << "nothing would be kept";
  const std::string other = folder_ / "other";
  const Finished finished = run({"assemble", run_, "--out", other});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.err.find("rejoin report will not find this assembly (--json FILE keeps its poses)"),
            std::string::npos)
      << finished.err;
  EXPECT_TRUE(std::filesystem::exists(other + "/assembled.glb"));
}

TEST_F(SecondAssembly, RemovesTheMatricesOfTheFirstAndNoneOfTheUser) {
  const std::string mine = out_ + "/cloudcompare/from_clicked_points.txt";
  write_file(mine, "1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n");
  ASSERT_EQ(run({"assemble", run_, "--out", out_, "--constraints", wishes_}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(mine));
  EXPECT_FALSE(std::filesystem::exists(out_ + "/cloudcompare/fragment_00.ply.txt"));
  EXPECT_TRUE(std::filesystem::exists(out_ + "/cloudcompare/fragment_01.ply.txt"));
  EXPECT_FALSE(std::filesystem::exists(out_ + "/rejoin.part"));
}

TEST_F(BrokenBall, AssembleOfAFolderTellsAScanThatCannotBeUsedByItsExitCode) {
  write_file(scans_ + "/notes.ply", "Dear diary,\n");
  const Finished finished = run({"assemble", scans_, "--json", json_, "--out", matched()});
  EXPECT_EQ(finished.exit_code, 1);
  const std::size_t told = finished.err.find("notes.ply");
  EXPECT_NE(told, std::string::npos) << finished.err;
  EXPECT_EQ(finished.err.find("notes.ply", told + 1), std::string::npos) << finished.err;
  const ordered_json result = ordered_json::parse(read_file(json_));
  ASSERT_EQ(result["unplaced"].size(), 1U) << "the rest is put together";
  EXPECT_EQ(result["unplaced"][0], "notes.ply");
}

TEST_F(BrokenBall, WhatIsAskedOfAScanThatCannotBeUsedNowStaysForTheNextAssembly) {
  write_file(scans_ + "/notes.ply", "Dear diary,\n");
  const std::string wishes = folder_ / "wishes.json";
  const ordered_json asked = ordered_json::parse(R"({"must_join": [["notes.ply", "fragment_00.ply"]],
      "must_not_join": [["fragment_01.ply", "notes.ply"]],
      "poses": {"notes.ply": [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}})");
  write_file(wishes, asked.dump());
  const Finished finished =
      run({"assemble", scans_, "--json", json_, "--constraints", wishes, "--out", matched()});
  EXPECT_NE(finished.err.find("\"must_join\"[0] is left out"), std::string::npos) << finished.err;
  const ordered_json kept = ordered_json::parse(read_file(json_))["constraints"];
  for (const auto& [key, value] : asked.items()) EXPECT_EQ(kept[key], value) << key;
  EXPECT_EQ(kept["problems"].size(), 3U);
}

TEST_F(BrokenBall, AssemblyOfARunTellsAScanOfAnotherUnit) {
  const std::string metres = scans_ + "/fragment_02.ply";
  mesh::Mesh scan = mesh::load(metres).mesh;
  for (glm::vec3& vertex : scan.vertices) vertex *= 1e-3F;
  mesh::save(metres, scan);
  const std::string kept = matched() + "/run";
  ASSERT_EQ(run({"batch", scans_, "--out", kept}).exit_code, 0);
  const Finished finished = run({"assemble", kept, "--json", json_});
  EXPECT_NE(finished.err.find("fragment_02.ply (diameter"), std::string::npos) << finished.err;
  EXPECT_NE(ordered_json::parse(read_file(json_))["warnings"].dump().find("fragment_02.ply (diameter"),
            std::string::npos);
}

TEST_F(BrokenBall, WhatIsNotThereIsNeitherRunNorFolder) {
  const Finished finished = run({"assemble", folder_ / "nosuch", "--json", json_});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
  EXPECT_NE(finished.err.find("is not there"), std::string::npos) << finished.err;
  EXPECT_NE(finished.err.find("a run of rejoin batch"), std::string::npos) << finished.err;
}

TEST_F(BrokenBall, AFolderOfScansIsNotMatchedForNothing) {
  const Finished finished = run({"assemble", scans_});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_NE(finished.err.find("--out"), std::string::npos) << finished.err;
  EXPECT_TRUE(finished.out.empty()) << finished.out;
}

TEST_F(BrokenBall, RunThatNobodyKeepsLeavesNothingAndNeedsAFolderForTheTime) {
  std::filesystem::create_directory(folder_ / "tmp");
  const Finished finished = run({"assemble", scans_, "--json", json_}, {"TMPDIR=" + (folder_ / "tmp")});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "tmp"));
  const Finished refused = run({"assemble", scans_, "--json", json_}, {"TMPDIR=" + (folder_ / "nosuch")});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(is_one_line(refused.err)) << refused.err;
  EXPECT_NE(refused.err.find("nosuch: cannot hold the run"), std::string::npos) << refused.err;
}

TEST_F(BrokenBall, RunThatNobodyKeepsLeavesNothingWhenItIsKilledByCtrlC) {
  std::filesystem::create_directory(folder_ / "tmp");
  Running running({"assemble", scans_, "--json", json_, "--verbose"}, {"TMPDIR=" + (folder_ / "tmp")});
  ASSERT_TRUE(running.wait_for_stderr("pairs are done already"));
  EXPECT_FALSE(std::filesystem::is_empty(folder_ / "tmp"));
  // Signals that are not handled yet are one: many make sure that a second one comes.
  for (int k = 0; k < 200; ++k) {
    running.interrupt();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(running.finish().exit_code, 130);
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "tmp"));
}

TEST_F(BrokenBall, RunThatNobodyKeepsLeavesNothingWhenItIsEndedByASystemOrAClosedTerminal) {
  std::filesystem::create_directory(folder_ / "tmp");
  for (const int signal_number : {SIGTERM, SIGHUP}) {
    Running running({"assemble", scans_, "--json", json_, "--verbose"}, {"TMPDIR=" + (folder_ / "tmp")});
    ASSERT_TRUE(running.wait_for_stderr("pairs are done already"));
    EXPECT_FALSE(std::filesystem::is_empty(folder_ / "tmp"));
    running.send(signal_number);
    EXPECT_EQ(running.finish().exit_code, 128 + signal_number);
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "tmp"));
    EXPECT_FALSE(std::filesystem::exists(json_)) << "it was interrupted";
  }
}

TEST_F(BrokenBall, WishesThatCannotBeReadAreRefusedBeforeAnyPairIsMatched) {
  const std::string wishes = folder_ / "wishes.json";
  for (const char* text : {"{", R"({"must_join": [["fragment_00.ply", "fragment_17.ply"]]})"}) {
    write_file(wishes, text);
    const Finished finished = run({"assemble", scans_, "--out", folder_ / "out", "--constraints", wishes});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_NE(finished.err.find(wishes), std::string::npos) << finished.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/run/run.sqlite"));
  }
}

TEST_F(BrokenBall, WishesMayComeThroughAPipe) {
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { write_file(pipe, R"({"must_join": [["fragment_00.ply", "fragment_01.ply"]]})"); });
  const Finished finished =
      run({"assemble", scans_, "--json", json_, "--constraints", pipe, "--out", matched()});
  writer.join();
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(ordered_json::parse(read_file(json_))["constraints"]["must_join"].size(), 1U);
}

TEST_F(BrokenBall, AFolderWithoutScansOrARunIsRefused) {
  std::filesystem::create_directory(folder_ / "empty");
  const Finished finished = run({"assemble", folder_ / "empty", "--json", json_});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
  EXPECT_FALSE(std::filesystem::exists(json_));
}

}  // namespace
}  // namespace rejoin::cli::testing
