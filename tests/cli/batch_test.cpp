#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "../match/planted_block.hpp"
#include "batch_runs.hpp"
#include "core/random.hpp"
#include "mesh/save.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

int pairs_with_poses(const std::string& run) {
  return SQLite::Database(run + "/run.sqlite", SQLite::OPEN_READONLY)
      .execAndGet("SELECT count(*) FROM (SELECT DISTINCT a, b FROM candidate)")
      .getInt();
}

void expect_whole(const std::string& run) {
  SQLite::Database database(run + "/run.sqlite", SQLite::OPEN_READONLY);
  EXPECT_EQ(database.execAndGet("PRAGMA integrity_check").getString(), "ok");
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM pragma_foreign_key_check").getInt(), 0);
}

/// Three pieces of two blocks, and the run of them that nobody disturbed.
class Batch : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    home_ = new TemporaryFolder;
    make_scans(scans());
    const auto begin = std::chrono::steady_clock::now();
    const Finished finished = run({"batch", scans(), "--out", *home_ / "undisturbed", "--threads", "1"});
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    reference_ = content(*home_ / "undisturbed");
    ASSERT_EQ(pairs_with_poses(*home_ / "undisturbed"), 3) << "runs without poses are easily the same";
    table_ = read_file(*home_ / "undisturbed/pairs.csv");
  }
  static void TearDownTestSuite() {
    delete home_;
    home_ = nullptr;
  }

  static std::string scans() { return *home_ / "scans"; }

  static TemporaryFolder* home_;
  static double seconds_;
  static std::string reference_;
  static std::string table_;
  const TemporaryFolder folder_;
  const std::string run_ = folder_ / "run";
};
TemporaryFolder* Batch::home_ = nullptr;
double Batch::seconds_ = 0;
std::string Batch::reference_;
std::string Batch::table_;

TEST_F(Batch, EveryPairIsDoneAndRanked) {
  EXPECT_EQ(pairs_in(*home_ / "undisturbed"), 3);
  EXPECT_EQ(table_.substr(0, table_.find('\n')).rfind("a,b,score,verdict", 0), 0U);
  EXPECT_EQ(std::count(table_.begin(), table_.end(), '\n'), 4);
  EXPECT_EQ(table_.find("truth"), std::string::npos);
}

TEST_F(Batch, NumberOfThreadsChangesNothing) {
  ASSERT_EQ(run({"batch", scans(), "--out", run_, "--threads", "3"}).exit_code, 0);
  EXPECT_EQ(content(run_), reference_);
  EXPECT_EQ(read_file(run_ + "/pairs.csv"), table_);
}

TEST_F(Batch, KilledTwentyTimesAndResumedIsAsUndisturbed) {
  Random random(20);
  int kills = 0;
  int runs = 0;
  while (kills < 20) {
    const std::string place = folder_ / std::to_string(runs++);
    for (bool ended = false; !ended && kills < 20;) {
      Running program({"batch", scans(), "--out", place, "--threads", "2"});
      std::this_thread::sleep_for(std::chrono::duration<double>(random.uniform(0.0, 0.5 * seconds_)));
      program.kill_now();
      const Finished finished = program.finish();
      ended = finished.exit_code == 0;
      kills += ended ? 0 : 1;
    }
    ASSERT_EQ(run({"batch", scans(), "--out", place, "--threads", "2"}).exit_code, 0);
    expect_whole(place);
    EXPECT_EQ(content(place), reference_) << "after " << kills << " kills";
  }
}

TEST_F(Batch, RunOfABuildWithAnotherMatcherIsDoneAgain) {
  fs::copy(*home_ / "undisturbed", run_, fs::copy_options::recursive);
  const std::string version = SQLite::Database(run_ + "/run.sqlite", SQLite::OPEN_READONLY)
                                  .execAndGet("SELECT version FROM run")
                                  .getString();
  const std::size_t build = version.find(" (matcher ");
  ASSERT_NE(build, std::string::npos) << version;
  SQLite::Database(run_ + "/run.sqlite", SQLite::OPEN_READWRITE)
      .exec("UPDATE run SET version = '" + version.substr(0, build) +
            " (matcher 0123456789)'; "
            "UPDATE pair SET score = 0.5");
  const Finished finished = run({"batch", scans(), "--out", run_});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.err.find("another version or build"), std::string::npos) << finished.err;
  EXPECT_EQ(content(run_), reference_);
}

TEST_F(Batch, SecondRunDoesNothing) {
  fs::copy(*home_ / "undisturbed", run_, fs::copy_options::recursive);
  const Finished again = run({"batch", scans(), "--out", run_ + "/"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.out.find("wrote " + run_ + "/pairs.csv"), std::string::npos) << again.out;
  EXPECT_NE(again.out.find("0 of them now"), std::string::npos) << again.out;
}

TEST_F(Batch, CandidatesAreThoseOfMatch) {
  const std::string answer = folder_ / "match.json";
  ASSERT_EQ(run({"match", scans() + "/a7.ply", scans() + "/b7.ply", "--json", answer}).exit_code, 0);
  SQLite::Database database(*home_ / "undisturbed/run.sqlite", SQLite::OPEN_READONLY);
  SQLite::Statement kept(
      database,
      "SELECT c.score, c.facet_a, c.facet_b, c.m14 FROM candidate c JOIN fragment x ON x.id = c.a "
      "JOIN fragment y ON y.id = c.b WHERE x.name = 'a7.ply' AND y.name = 'b7.ply' ORDER BY c.rank");
  const json candidates = json::parse(read_file(answer)).at("candidates");
  ASSERT_FALSE(candidates.empty());
  for (const json& candidate : candidates) {
    ASSERT_TRUE(kept.executeStep());
    EXPECT_EQ(candidate.at("score"), kept.getColumn(0).getDouble());
    EXPECT_EQ(candidate.at("facet_a"), kept.getColumn(1).getInt());
    EXPECT_EQ(candidate.at("facet_b"), kept.getColumn(2).getInt());
    EXPECT_EQ(candidate.at("pose").at(0).at(3), kept.getColumn(3).getDouble());
  }
  EXPECT_FALSE(kept.executeStep());
}

TEST_F(Batch, AllPairsOfFewScansAreSearchedInFull) {
  EXPECT_EQ(
      stages_in(*home_ / "undisturbed"),
      (std::vector<std::string>{"a7.ply+a8.ply: match", "a7.ply+b7.ply: match", "a8.ply+b7.ply: match"}));
}

TEST_F(Batch, BadScanIsReportedAndTheRestGoesOn) {
  make_scans(folder_ / "scans");
  write_file(folder_ / "scans/c.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 1000\n");
  const Finished finished = run({"batch", folder_ / "scans", "--out", run_});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.err.find("c.ply"), std::string::npos);
  SQLite::Database database(run_ + "/run.sqlite", SQLite::OPEN_READONLY);
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM pair WHERE stage <> 'failed'").getInt(), 3);
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM pair WHERE stage = 'failed'").getInt(), 3);
  const Finished again = run({"batch", folder_ / "scans", "--out", run_});
  EXPECT_EQ(again.exit_code, 1) << "still bad";
  EXPECT_NE(again.out.find("6 of 6 pairs done, 0 of them now, 3 failed"), std::string::npos) << again.out;
  ASSERT_EQ(run({"assemble", run_}).exit_code, 0);
  const std::string reason = json::parse(read_file(run_ + "/assembly.json"))["fragments"]["c.ply"]["reason"];
  EXPECT_EQ(reason.find("c.ply"), reason.rfind("c.ply")) << reason;

  mesh::save(folder_ / "scans/c.ply", match::testing::planted_pair(9, kCells).a);
  const Finished mended = run({"batch", folder_ / "scans", "--out", run_});
  EXPECT_EQ(mended.exit_code, 0) << mended.err;
  EXPECT_NE(mended.out.find("6 of 6 pairs done, 3 of them now"), std::string::npos) << mended.out;
}

TEST_F(Batch, ChangedScanAndChangedParametersAreDoneAgain) {
  fs::copy(*home_ / "undisturbed", run_, fs::copy_options::recursive);
  make_scans(folder_ / "scans");
  mesh::save(folder_ / "scans/a8.ply", match::testing::planted_pair(9, kCells).a);
  const Finished changed = run({"batch", folder_ / "scans", "--out", run_});
  EXPECT_NE(changed.out.find("3 of 3 pairs done, 2 of them now"), std::string::npos) << changed.out;
  EXPECT_NE(changed.err.find("a8.ply: has changed; its pairs are done again"), std::string::npos)
      << changed.err;
  const Finished seeded = run({"batch", folder_ / "scans", "--out", run_, "--seed", "2"});
  EXPECT_NE(seeded.out.find("3 of 3 pairs done, 3 of them now"), std::string::npos) << seeded.out;
  EXPECT_NE(seeded.err.find("other parameters"), std::string::npos);
}

TEST_F(Batch, ShardsMergedAreTheWhole) {
  std::vector<std::string> merge = {"merge", "--out", run_};
  for (const char* shard : {"1/3", "2/3", "3/3"}) {
    const std::string place = folder_ / std::string(1, shard[0]);
    ASSERT_EQ(run({"batch", scans(), "--out", place, "--shard", shard}).exit_code, 0);
    merge.push_back(place);
  }
  ASSERT_EQ(run(merge).exit_code, 0);
  EXPECT_EQ(content(run_), reference_);
  EXPECT_EQ(read_file(run_ + "/pairs.csv"), table_);
  int surfaces = 0;
  for (const auto& kept : fs::directory_iterator(*home_ / "undisturbed/fragments")) {
    EXPECT_EQ(read_file(run_ + "/fragments/" + kept.path().filename().string()), read_file(kept.path()));
    ++surfaces;
  }
  EXPECT_EQ(surfaces, 3);
  const Finished partly = run({"merge", merge[3], merge[5], "--out", folder_ / "partly"});
  EXPECT_EQ(partly.exit_code, 0);
  EXPECT_NE(partly.err.find("shard 2/3 is missing"), std::string::npos) << partly.err;
  const Finished none = run({"batch", scans(), "--out", folder_ / "none", "--shard", "9/9"});
  EXPECT_NE(none.err.find("shard 9/9 has no pairs"), std::string::npos) << none.err;
  EXPECT_EQ(run({"batch", scans(), "--out", folder_ / "1", "--shard", "2/3"}).exit_code, 1)
      << "holds shard 1/3";
}

TEST_F(Batch, ShardRefusesAFolderOfOtherScans) {
  ASSERT_EQ(run({"batch", scans(), "--out", run_, "--shard", "1/2"}).exit_code, 0);
  const std::string before = content(run_);
  for (const auto& [scan, seed] :
       {std::pair("/x.ply", 21), std::pair("/y.ply", 22), std::pair("/z.ply", 23)}) {
    fs::create_directories(folder_ / "other");
    mesh::save(folder_ / "other" + scan, match::testing::planted_pair(seed, kCells).a);
  }
  const Finished refused = run({"batch", folder_ / "other", "--out", run_, "--shard", "1/2"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("is of other scans"), std::string::npos) << refused.err;
  EXPECT_EQ(content(run_), before);
}

TEST_F(Batch, SameScanUnderTwoNamesIsToldAndLeftOutByWholeRunsAndShards) {
  make_scans(folder_ / "scans");
  fs::copy_file(folder_ / "scans/b7.ply", folder_ / "scans/a9.ply");
  const std::string told = "a9.ply and b7.ply are the same scan: b7.ply is left out";
  const Finished finished = run({"batch", folder_ / "scans", "--out", run_, "--json"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.err.find(told), std::string::npos) << finished.err;
  EXPECT_NE(finished.out.find(told), std::string::npos) << finished.out;
  EXPECT_EQ(pairs_in(run_), 3);
  std::vector<std::string> merge = {"merge", "--out", folder_ / "whole"};
  for (const char* shard : {"1/2", "2/2"}) {
    merge.push_back(folder_ / std::string(1, shard[0]));
    ASSERT_EQ(run({"batch", folder_ / "scans", "--out", merge.back(), "--shard", shard}).exit_code, 0);
  }
  const Finished merged = run(merge);
  EXPECT_EQ(merged.out.find("still to be done"), std::string::npos) << merged.out;
  EXPECT_EQ(content(folder_ / "whole"), content(run_));

  write_file(folder_ / "wishes.json", R"({"must_not_join": [["b7.ply", "a7.ply"]]})");
  const Finished assembled = run({"assemble", run_, "--constraints", folder_ / "wishes.json"});
  ASSERT_EQ(assembled.exit_code, 0) << assembled.err;
  EXPECT_EQ(assembled.err.find("left out, as"), std::string::npos) << assembled.err;
  const json assembly = json::parse(read_file(run_ + "/assembly.json"));
  EXPECT_EQ(assembly["fragments"]["b7.ply"]["reason"], "is the same scan as a9.ply, which stands for both");
  EXPECT_EQ(assembly["constraints"]["must_not_join"], json::parse(R"([["b7.ply", "a7.ply"]])"));
  EXPECT_EQ(assembly["constraints"]["problems"].size(), 0U);
}

TEST_F(Batch, CopyThatComesLaterTakesNoPairs) {
  fs::copy(*home_ / "undisturbed", run_, fs::copy_options::recursive);
  make_scans(folder_ / "scans");
  fs::copy_file(folder_ / "scans/b7.ply", folder_ / "scans/b.ply");
  const Finished finished = run({"batch", folder_ / "scans", "--out", run_});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.out.find("3 of 3 pairs done, 0 of them now"), std::string::npos) << finished.out;
  EXPECT_NE(finished.err.find("b7.ply and b.ply are the same scan: b.ply is left out"), std::string::npos)
      << finished.err;
  EXPECT_TRUE(has_the_join(run_));
  const Finished merged = run({"merge", run_, "--out", run_});
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(merged.out.find("still to be done"), std::string::npos) << merged.out;
  EXPECT_TRUE(has_the_join(run_));
}

TEST_F(Batch, RunKnowsItsScansFromAnyFolderAndKeepsTheirSurfacesWhereTheyAreGone) {
  make_scans(folder_ / "scans");
  ASSERT_EQ(
      std::system(("cd " + (folder_ / "") + " && " REJOIN_PROGRAM " batch scans --out run --quiet").c_str()),
      0);
  SQLite::Database database(run_ + "/run.sqlite", SQLite::OPEN_READONLY);
  EXPECT_EQ(database.execAndGet("SELECT path FROM fragment WHERE name = 'a7.ply'").getString(),
            folder_ / "scans/a7.ply");
#ifdef REJOIN_VIEWER
  ASSERT_EQ(run({"report", run_, "--pictures", "0"}).err, "");
  fs::rename(folder_ / "scans", folder_ / "moved");
  const Finished kept = run({"report", run_, "--pictures", "0"});
  EXPECT_EQ(kept.exit_code, 0);
  EXPECT_NE(kept.err.find("3 scans cannot be read where rejoin batch found them"), std::string::npos)
      << kept.err;
  EXPECT_EQ(kept.err.find("no surface"), std::string::npos) << kept.err;
  fs::remove_all(run_ + "/fragments");
  const Finished nothing = run({"report", run_, "--pictures", "0"});
  EXPECT_NE(nothing.err.find("no surface could be read"), std::string::npos) << nothing.err;
  EXPECT_EQ(nothing.err.find("what the run keeps"), std::string::npos) << nothing.err;
#endif
}

TEST_F(Batch, ScanWhoseNameNoResultCanTellIsReportedAndTheRestGoesOn) {
  make_scans(folder_ / "scans");
  fs::copy(folder_ / "scans/a8.ply", folder_ / "scans/c\t8.ply");
  const Finished finished = run({"batch", folder_ / "scans", "--out", run_});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.err.find("8.ply: has a line end, tab or other control character"), std::string::npos)
      << finished.err;
  EXPECT_NE(finished.err.find("0 of 3 pairs failed, 1 scan cannot be used"), std::string::npos)
      << finished.err;
  EXPECT_EQ(content(run_), reference_);
}

TEST_F(Batch, ScanReplacedSinceIsToldAndWhatWasMatchedIsAssembled) {
  make_scans(folder_ / "scans");
  ASSERT_EQ(run({"batch", folder_ / "scans", "--out", run_, "--quiet"}).exit_code, 0);
  ASSERT_EQ(run({"assemble", run_}).err, "");
  const std::string before = read_file(run_ + "/assembly.json");
  mesh::save(folder_ / "scans/b7.ply", match::testing::planted_pair(9, kCells).a);
  const std::string told = "1 scan changed since rejoin batch matched it (b7.ply)";
  const Finished assembled = run({"assemble", run_ + "/run.sqlite"});
  EXPECT_EQ(assembled.exit_code, 0) << assembled.err;
  EXPECT_NE(assembled.err.find(told), std::string::npos) << assembled.err;
  const json after = json::parse(read_file(run_ + "/assembly.json"));
  EXPECT_EQ(after["fragments"], json::parse(before)["fragments"]);
  EXPECT_EQ(after["warnings"][0].get<std::string>().find(told), 0U);
#ifdef REJOIN_VIEWER
  const Finished report = run({"report", run_, "--pictures", "0"});
  EXPECT_NE(report.err.find(told), std::string::npos) << report.err;
  fs::remove_all(run_ + "/fragments");
  const Finished without = run({"report", run_, "--pictures", "0"});
  EXPECT_NE(without.err.find("b7.ply: is no longer what rejoin batch matched"), std::string::npos)
      << without.err;
#endif
  fs::remove_all(run_ + "/fragments");
  const Finished refused = run({"assemble", run_});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("assembly.json: is kept, as 1 scan of the run cannot be used any more (b7.ply)"),
            std::string::npos)
      << refused.err;
  EXPECT_EQ(json::parse(read_file(run_ + "/assembly.json"))["fragments"], after["fragments"]);
  fs::remove(run_ + "/assembly.json");
  const Finished left_out = run({"assemble", run_});
  EXPECT_EQ(left_out.exit_code, 1);
  EXPECT_EQ(left_out.err.find("what the run keeps"), std::string::npos) << left_out.err;
  const json lost = json::parse(read_file(run_ + "/assembly.json"));
  EXPECT_NE(lost["fragments"]["b7.ply"]["reason"].get<std::string>().find("another content"),
            std::string::npos)
      << lost["fragments"];
  EXPECT_TRUE(lost["fragments"]["a7.ply"].contains("scan")) << "made ready again";
}

TEST_F(Batch, ScanInMetresAmongMillimetresIsTold) {
  make_scans(folder_ / "scans");
  mesh::Mesh metres = match::testing::planted_pair(9, kCells).a;
  metres.origin *= 0.001;
  for (glm::vec3& v : metres.vertices) v *= 0.001F;
  mesh::save(folder_ / "scans/m.ply", metres);
  const Finished finished = run({"batch", folder_ / "scans", "--out", run_});
  EXPECT_NE(finished.err.find("m.ply (diameter 0.1"), std::string::npos) << finished.err;
  EXPECT_NE(finished.err.find("same unit"), std::string::npos) << finished.err;
  EXPECT_EQ(finished.err.find("a7.ply ("), std::string::npos) << finished.err;
}

TEST_F(Batch, AssemblyOfAnUnfinishedRunSaysHowManyPairsAreMissing) {
  fs::copy(*home_ / "undisturbed", run_, fs::copy_options::recursive);
  SQLite::Database(run_ + "/run.sqlite", SQLite::OPEN_READWRITE)
      .exec(
          "UPDATE candidate SET score = 0.1; DELETE FROM pair WHERE a = (SELECT id FROM fragment WHERE name "
          "= 'a7.ply')");
  const Finished assembled = run({"assemble", run_});
  ASSERT_EQ(assembled.exit_code, 0) << assembled.err;
  const std::string told = "2 of 3 pairs are not compared yet";
  EXPECT_NE(assembled.err.find(told), std::string::npos) << assembled.err;
  EXPECT_EQ(assembled.out.find(told), std::string::npos) << "once is enough: " << assembled.out;
  const json assembly = json::parse(read_file(run_ + "/assembly.json"));
  EXPECT_EQ(assembly["pairs_missing"], 2);
  ASSERT_EQ(assembly["warnings"].size(), 1U);
  EXPECT_EQ(assembly["warnings"][0].get<std::string>().rfind(told, 0), 0U);
  const auto reason = [&](const char* name) {
    return assembly["fragments"][name]["reason"].get<std::string>();
  };
  EXPECT_EQ(reason("a7.ply"), "none of its 2 pairs is compared yet") << reason("a7.ply");
  EXPECT_NE(reason("b7.ply").find("1 of its 2 pairs is not compared yet"), std::string::npos)
      << reason("b7.ply");
  const std::string advice = "see what counts as their breaks";
  EXPECT_NE(assembled.out.find(advice), std::string::npos) << assembled.out;
  SQLite::Database(run_ + "/run.sqlite", SQLite::OPEN_READWRITE)
      .exec("DELETE FROM candidate; DELETE FROM pair");
  const Finished nothing_compared = run({"assemble", run_});
  ASSERT_EQ(nothing_compared.exit_code, 0) << nothing_compared.err;
  EXPECT_EQ(nothing_compared.out.find(advice), std::string::npos) << nothing_compared.out;
}

TEST_F(Batch, PairThatMustJoinButHasNoPoseIsToldWithTheReason) {
  fs::copy(*home_ / "undisturbed", run_, fs::copy_options::recursive);
  write_file(folder_ / "wishes.json", R"({"must_join": [["b7.ply", "a7.ply"]]})");
  const auto told = [&](const std::string& change) {
    SQLite::Database(run_ + "/run.sqlite", SQLite::OPEN_READWRITE).exec(change);
    return run({"assemble", run_, "--constraints", folder_ / "wishes.json"}).err;
  };
  const std::string theirs =
      " WHERE a = (SELECT id FROM fragment WHERE name = 'a7.ply') AND b = (SELECT id FROM fragment WHERE "
      "name = 'b7.ply'); ";
  const std::string wish = "a7.ply and b7.ply must join, but no pose of the two is known: ";
  for (const auto& [change, says] : std::vector<std::pair<std::string, std::string>>{
           {"UPDATE candidate SET score = 0.1; DELETE FROM candidate" + theirs, "their search found none"},
           {"UPDATE pair SET stage = 'apart'" + theirs, "the layout has them too far apart to touch"},
           {"UPDATE pair SET stage = 'failed', error = 'full'" + theirs, "they could not be compared"},
           {"DELETE FROM pair" + theirs, "they are not compared yet"}}) {
    const std::string err = told(change);
    EXPECT_NE(err.find(wish + says), std::string::npos) << err;
  }
}

TEST_F(Batch, JoinOfALowScoreThatTheUserAsksForIsToldAsTheUsers) {
  fs::copy(*home_ / "undisturbed", run_, fs::copy_options::recursive);
  write_file(folder_ / "wishes.json", R"({"must_join": [["b7.ply", "a7.ply"]]})");
  SQLite::Database(run_ + "/run.sqlite", SQLite::OPEN_READWRITE).exec("UPDATE candidate SET score = 0.1");
  const Finished wished = run({"assemble", run_, "--constraints", folder_ / "wishes.json"});
  ASSERT_EQ(wished.exit_code, 0) << wished.err;
  EXPECT_NE(wished.out.find("a7.ply + b7.ply: score 0.100"), std::string::npos) << wished.out;
  EXPECT_NE(wished.out.find("; as you said\n"), std::string::npos) << wished.out;
  EXPECT_EQ(wished.out.find("others bear it out"), std::string::npos) << wished.out;
}

TEST_F(Batch, JsonLinesAreValidAndCountUp) {
  const Finished finished = run({"batch", scans(), "--out", run_, "--json"});
  ASSERT_EQ(finished.exit_code, 0);
  std::istringstream lines(finished.out);
  std::vector<json> events;
  for (std::string line; std::getline(lines, line);) events.push_back(json::parse(line));
  ASSERT_EQ(events.size(), 1U + 3U + 3U + 1U);
  EXPECT_EQ(events.front()["event"], "start");
  EXPECT_EQ(events.back()["event"], "end");
  int done = 0;
  for (const json& event : events) {
    EXPECT_GE(event["done"], done);
    done = event["done"];
    EXPECT_EQ(event["total"], 3);
  }
  EXPECT_EQ(done, 3);
  EXPECT_TRUE(events.front()["seconds_left"].is_null()) << "nothing to tell by yet";
  EXPECT_EQ(events.back()["seconds_left"], 0);
  const Finished quiet = run({"batch", scans(), "--out", run_, "--json", "--quiet"});
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.out, "") << "--quiet: no results";
}

TEST_F(Batch, InterruptKeepsWhatIsDoneAndSaysHowToGoOn) {
  Running program({"batch", scans(), "--out", run_, "--threads", "1", "--json"});
  ASSERT_TRUE(program.wait_for_stdout("\"event\":\"pair\""));
  program.interrupt();
  const Finished finished = program.finish();
  ASSERT_TRUE(finished.exit_code == 130 || pairs_in(run_) == 3) << finished.exit_code << finished.err;
  EXPECT_GE(pairs_in(run_), 1);
  EXPECT_TRUE(fs::exists(run_ + "/pairs.csv"));
  ASSERT_EQ(run({"batch", scans(), "--out", run_}).exit_code, 0);
  EXPECT_EQ(content(run_), reference_);
}

TEST_F(Batch, FullDiskIsToldAndNothingDoneIsLost) {
  const std::string program =
      "ulimit -f 40; trap \"\" XFSZ; exec \"$0\" batch \"$1\" --out \"$2\" --threads 1";
  const std::string command =
      "bash -c '" + program + "' " REJOIN_PROGRAM " " + scans() + " " + run_ + " 2> " + (folder_ / "err");
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_NE(read_file(folder_ / "err").find("space"), std::string::npos) << read_file(folder_ / "err");
  expect_whole(run_);
  ASSERT_EQ(run({"batch", scans(), "--out", run_}).exit_code, 0);
  EXPECT_EQ(content(run_), reference_);
}

TEST_F(Batch, LargestSeedIsKeptAsItIs) {
  ASSERT_EQ(run({"batch", scans(), "--out", run_, "--seed", "9223372036854775807"}).exit_code, 0);
  EXPECT_EQ(SQLite::Database(run_ + "/run.sqlite").execAndGet("SELECT seed FROM run").getString(),
            "9223372036854775807");
}

TEST_F(Batch, WrongUseIsToldBeforeAnythingIsWritten) {
  for (const char* shard : {"0/8", "9/8", "1", "1/", "/8", "1/8x", "-1/8"}) {
    const std::vector<std::string> words = {"batch", scans(), "--out", run_, std::string("--shard=") + shard};
    EXPECT_EQ(run(words).exit_code, 2) << shard;
  }
  EXPECT_EQ(run({"batch", folder_ / "nowhere", "--out", run_}).exit_code, 1);
  EXPECT_FALSE(fs::exists(run_));
}

}  // namespace
}  // namespace rejoin::cli::testing
