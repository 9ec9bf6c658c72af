#include "store/run.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/error.hpp"
#include "run_fixture.hpp"
#include "store/remains.hpp"

namespace rejoin::store {
namespace {
namespace fs = std::filesystem;
using testing::fragment;
using testing::kParameters;
using testing::RunTest;

TEST_F(RunTest, WhatIsSavedComesBackToTheLastBit) {
  make_run();
  const store::Run run = store::Run::open(folder_);
  EXPECT_EQ(run.parameters(), kParameters);
  ASSERT_EQ(run.fragments().size(), 3U);
  EXPECT_EQ(run.fragments()[0].name, "a.ply");
  const std::vector<Pair> pairs = run.pairs();
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].name_a, "a.ply");
  EXPECT_EQ(pairs[0].name_b, "b.ply");
  EXPECT_EQ(pairs[0].stage, Stage::Match);
  const std::vector<Candidate> candidates = run.candidates(pairs[0]);
  ASSERT_EQ(candidates.size(), 1U);
  EXPECT_EQ(candidates[0].rank, 1);
  EXPECT_EQ(candidates[0].pose.rotation, candidate_.pose.rotation);
  EXPECT_EQ(candidates[0].pose.translation, candidate_.pose.translation);
  EXPECT_TRUE(candidates[0].slides);
  EXPECT_EQ(candidates[0].facet_a, 2);
  EXPECT_EQ(candidates[0].facet_b, -1);
  EXPECT_EQ(candidates[0].gap_median, 0.125);
  EXPECT_TRUE(std::isinf(candidates[0].raycast)) << "not measured";
}

TEST_F(RunTest, PairSavedAgainReplacesItsCandidates) {
  make_run();
  store::Run run = store::Run::write(folder_);
  Pair again = run.pairs().at(0);
  again.score = 0.25;
  run.save(again, {});
  EXPECT_EQ(run.pairs().at(0).score, 0.25);
  EXPECT_TRUE(run.candidates(again).empty());
  EXPECT_EQ(run.done().size(), 1U);
}

TEST_F(RunTest, CandidateWithoutPoseOrScoreIsRefused) {
  make_run();
  const auto candidates = [&] {
    const store::Run run = store::Run::open(folder_);
    return run.candidates(run.pairs().at(0));
  };
  SQLite::Database database((folder_ / kFileName).string(), SQLite::OPEN_READWRITE);
  for (const char* change : {"m12 = 'a word'", "m12 = 2", "m14 = 9e999", "score = 1.5", "score = ''"}) {
    database.exec(std::string("UPDATE candidate SET ") + change);
    EXPECT_THROW(candidates(), StoreError) << change;
    store::Run::write(folder_).save(store::Run::open(folder_).pairs().at(0), {candidate_});
    EXPECT_EQ(candidates().size(), 1U);
  }
}

TEST_F(RunTest, FragmentWhoseNameOrHashLeadsElsewhereIsRefused) {
  const auto expect_refused = [this](const std::string& change) {
    make_run();
    SQLite::Database(folder_ / kFileName, SQLite::OPEN_READWRITE)
        .exec("UPDATE fragment SET " + change + " WHERE name = 'b.ply'");
    try {
      static_cast<void>(store::Run::open(folder_).fragments());
      ADD_FAILURE() << change;
    } catch (const StoreError& error) {
      const std::string told = error.what();
      EXPECT_EQ(told.find((folder_ / kFileName).string()), 0U) << told;
      EXPECT_NE(told.find("its fragment 2 ("), std::string::npos) << told;
      EXPECT_NE(told.find("run rejoin batch again"), std::string::npos) << told;
    }
    fs::remove(folder_ / kFileName);
  };
  for (const char* name : {"''", "'.'", "'..'", "'../../evil'", "'/etc/x'", "'a' || char(0) || 'b'",
                           "'a' || char(10)", "CAST(x'61ff62' AS TEXT)"})
    expect_refused(std::string("name = ") + name);
  expect_refused("path = ''");
  for (const char* hash : {"''", "'../../evil'", "'12 34'"}) expect_refused(std::string("hash = ") + hash);
  expect_refused("facets = '../../evil'");
}

TEST_F(RunTest, WhatAnotherVersionCouldNotReadIsTriedAgain) {
  make_run();
  store::Run run = store::Run::write(folder_);
  Fragment bad = run.fragments()[2];
  bad.state = FragmentState::Bad;
  bad.error = "cannot be read";
  run.save(bad);
  run.begin(kParameters, three_);
  EXPECT_EQ(run.fragments()[2].state, FragmentState::Bad);
  run.begin({"0.2.0", kParameters.json, kParameters.seed}, three_);
  EXPECT_EQ(run.fragments()[2].state, FragmentState::Waiting);
  EXPECT_EQ(run.fragments()[2].error, "");
}

TEST_F(RunTest, FailuresAreForgottenAndNothingElse) {
  make_run();
  store::Run run = store::Run::write(folder_);
  Pair failed = pair_of(run.fragments(), 0, 2);
  failed.stage = Stage::Failed;
  failed.error = "c.ply: is empty";
  run.save(failed, {});
  Fragment bad = run.fragments()[2];
  bad.state = FragmentState::Bad;
  run.save(bad);
  ASSERT_EQ(run.done().size(), 2U);
  EXPECT_EQ(run.done()[1].stage, Stage::Failed);
  run.forget_failures();
  ASSERT_EQ(run.done().size(), 1U);
  EXPECT_NE(run.done()[0].stage, Stage::Failed);
  EXPECT_EQ(run.fragments()[2].state, FragmentState::Waiting);
}

TEST_F(RunTest, SecondWriterIsRefusedAndReadersAreNot) {
  make_run();
  const store::Run writer = store::Run::write(folder_);
  EXPECT_THROW(store::Run::write(folder_), StoreError);
  EXPECT_EQ(store::Run::open(folder_).pairs().size(), 1U);
}

TEST_F(RunTest, ReaderSeesWhatWasThereWhenItOpened) {
  make_run();
  const store::Run reader = store::Run::open(folder_);
  {
    store::Run writer = store::Run::write(folder_);
    writer.save(pair_of(writer.fragments(), 1, 2), {candidate_});
    writer.begin(kParameters, {three_[0], three_[1]});
  }
  EXPECT_EQ(reader.fragments().size(), 3U);
  EXPECT_EQ(reader.pairs().size(), 1U);
  EXPECT_EQ(store::Run::open(folder_).fragments().size(), 2U);
}

TEST_F(RunTest, WhoMayNotWriteReadsTheNewestResultsOrIsRefused) {
  const fs::path run = stopped_run({"", "-wal", "-shm"});
  EXPECT_EQ(pairs_without_writing(run), 2);
  fs::remove(run / (std::string(kFileName) + "-shm"));
  EXPECT_EQ(pairs_without_writing(run), -1) << "the journal cannot be read without a file beside it";
}

TEST_F(RunTest, WhoMayNotWriteReadsARunThatIsWhole) {
  make_run();
  EXPECT_EQ(pairs_without_writing(folder_), 1);
}

TEST_F(RunTest, OtherFilesAreRefused) {
  EXPECT_THROW(store::Run::open(folder_), StoreError) << "nothing there";
  std::ofstream(folder_ / kFileName) << "Dear diary, this is no database, but it is longer than a header.";
  EXPECT_THROW(store::Run::open(folder_), StoreError);
  EXPECT_THROW(store::Run::write(folder_), StoreError);
  fs::remove(folder_ / kFileName);
  SQLite::Database(folder_ / kFileName, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec("CREATE TABLE t (x)");
  EXPECT_THROW(store::Run::open(folder_), StoreError);
  EXPECT_THROW(store::Run::write(folder_), StoreError);
}

TEST_F(RunTest, FileOfTheUsersIsNotToBeMovedAway) {
  std::ofstream(folder_ / "scan.ply") << "ply, but no database, which is longer than the header of one";
  try {
    store::Run::open(folder_ / "scan.ply");
    FAIL() << "opened";
  } catch (const StoreError& error) {
    EXPECT_NE(std::string(error.what()).find("give the folder that rejoin batch wrote"), std::string::npos)
        << error.what();
  }
}

TEST_F(RunTest, FolderIsKnownByTheFilesInIt) {
  make_run();
  EXPECT_EQ(folder_of(folder_ / kFileName), folder_);
  EXPECT_EQ(folder_of(folder_), folder_);
  EXPECT_EQ(folder_of("nosuch.sqlite"), "nosuch.sqlite");
}

TEST_F(RunTest, NewerSchemaIsRefused) {
  make_run();
  SQLite::Database(folder_ / kFileName, SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 99");
  try {
    store::Run::open(folder_);
    FAIL() << "opened";
  } catch (const StoreError& error) {
    EXPECT_NE(std::string(error.what()).find("schema 99"), std::string::npos) << error.what();
  }
}

TEST_F(RunTest, EarlierSchemaIsReadAndBroughtUpToDateWhenWritten) {
  make_run();
  const auto as_written_earlier = [this] {
    SQLite::Database(folder_ / kFileName, SQLite::OPEN_READWRITE)
        .exec(
            "ALTER TABLE fragment DROP COLUMN spacing; ALTER TABLE fragment DROP COLUMN noise; "
            "ALTER TABLE fragment DROP COLUMN wall; ALTER TABLE fragment DROP COLUMN pose; "
            "ALTER TABLE fragment DROP COLUMN facets; ALTER TABLE candidate DROP COLUMN slides; "
            "PRAGMA user_version = 1");
  };
  as_written_earlier();
  EXPECT_EQ(store::Run::open(folder_).fragments().at(0).wall, 0);
  EXPECT_EQ(store::Run::open(folder_).pairs().size(), 1U);

  store::Run run = store::Run::write(folder_);
  Fragment measured = run.fragments().at(0);
  measured.spacing = 0.5;
  measured.noise = 0.03;
  measured.wall = 6.25;
  run.save(measured);
  EXPECT_EQ(run.pairs().size(), 1U);
  EXPECT_EQ(store::Run::open(folder_).fragments().at(0), measured);
}

TEST_F(RunTest, PairsOfAnEarlierSchemaStayWithTheirPosesAndNewOnesMayBeApart) {
  make_run();
  {
    SQLite::Database database(folder_ / kFileName, SQLite::OPEN_READWRITE);
    std::string pairs = database.execAndGet("SELECT sql FROM sqlite_master WHERE name = 'pair'").getString();
    const std::size_t apart = pairs.find("'apart', ");
    ASSERT_NE(apart, std::string::npos) << pairs;
    database.exec("PRAGMA writable_schema = ON");
    SQLite::Statement change(database, "UPDATE sqlite_master SET sql = ? WHERE name = 'pair'");
    change.bind(1, pairs.erase(apart, std::string("'apart', ").size()));
    change.exec();
    database.exec(
        "ALTER TABLE fragment DROP COLUMN pose; ALTER TABLE fragment DROP COLUMN facets; "
        "ALTER TABLE candidate DROP COLUMN slides; PRAGMA user_version = 2");
  }
  EXPECT_EQ(store::Run::open(folder_).fragments().at(0).pose, "");
  {
    store::Run run = store::Run::write(folder_);
    ASSERT_EQ(run.pairs().size(), 1U);
    EXPECT_EQ(run.candidates(run.pairs()[0]).size(), 1U);
    Pair apart = pair_of(run.fragments(), 1, 2);
    apart.stage = Stage::Apart;
    run.save(apart, {});
    run.begin(kParameters, {three_[0], three_[1]});
  }
  SQLite::Database database(folder_ / kFileName, SQLite::OPEN_READONLY);
  EXPECT_EQ(database.execAndGet("PRAGMA integrity_check").getString(), "ok");
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM pragma_foreign_key_check").getInt(), 0);
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM ranked").getInt(), 1) << "gone with its fragment";
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM candidate").getInt(), 1);
}

TEST_F(RunTest, PairsThatWereNotSearchedInFullAreTold) {
  make_run();
  store::Run run = store::Run::write(folder_);
  Pair soon = pair_of(run.fragments(), 1, 2);
  soon.stage = Stage::Sweep;
  run.save(soon, {});
  const std::vector<Fragment> fragments = run.fragments();
  const auto told_of = [&](std::size_t k) { return told(remains(run), fragments[k].name); };
  EXPECT_EQ(told_of(0), "1 of its 2 pairs is not compared yet");
  EXPECT_EQ(
      told_of(1),
      "1 of its 2 pairs looked hopeless soon and was not searched in full (rejoin batch --thorough does)");
  EXPECT_EQ(told_of(2),
            "1 of its 2 pairs is not compared yet; 1 of its 2 pairs looked hopeless soon and was not "
            "searched in full "
            "(rejoin batch --thorough does)");
}

TEST_F(RunTest, PairsThatTheLayoutKeptApartAreTold) {
  make_run();
  store::Run run = store::Run::write(folder_);
  const auto lay_apart = [&run](std::size_t a, std::size_t b) {
    Pair pair = pair_of(run.fragments(), a, b);
    pair.stage = Stage::Apart;
    run.save(pair, {});
  };
  const auto name = [&run](std::size_t k) { return run.fragments()[k].name; };
  lay_apart(1, 2);
  EXPECT_EQ(told(remains(run), name(1)),
            "1 of its 2 pairs was not searched, as the layout has them too far apart to touch");
  EXPECT_TRUE(is_searched(remains(run), name(1)));
  EXPECT_FALSE(is_searched(remains(run), name(2))) << "one pair is missing, the other one was laid apart";
  lay_apart(0, 2);
  EXPECT_EQ(told(remains(run), name(2)),
            "none of its 2 pairs was searched, as the layout has them too far apart to touch");
  EXPECT_TRUE(is_searched(remains(run)));
  lay_apart(0, 1);
  EXPECT_FALSE(is_searched(remains(run)));
}

TEST_F(RunTest, CandidatesOfAnEarlierSchemaAreReadAsHeld) {
  make_run();
  SQLite::Database(folder_ / kFileName, SQLite::OPEN_READWRITE)
      .exec("ALTER TABLE candidate DROP COLUMN slides; PRAGMA user_version = 3");
  const auto candidates = [](const store::Run& run) { return run.candidates(run.pairs().at(0)); };
  const std::vector<Candidate> earlier = candidates(store::Run::open(folder_));
  ASSERT_EQ(earlier.size(), 1U);
  EXPECT_FALSE(earlier[0].slides);
  store::Run run = store::Run::write(folder_);
  run.save(run.pairs().at(0), {candidate_});
  EXPECT_TRUE(candidates(store::Run::open(folder_)).at(0).slides);
}

TEST_F(RunTest, PairsGoThatAreLaidOtherwiseAndNoOthers) {
  const auto laid = [this](const std::string& a, const std::string& b, const std::string& c) {
    std::vector<Fragment> list = three_;
    list[1].pose = a;
    list[0].pose = b;
    list[2].pose = c;
    return list;
  };
  store::Run run = store::Run::write(folder_);
  const auto forgotten = [&](const std::vector<Fragment>& list) {
    const auto result = run.begin(kParameters, list);
    EXPECT_TRUE(result.fragments.empty());
    EXPECT_FALSE(result.parameters);
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
      const auto known = run.fragments();
      run.save(pair_of(known, static_cast<std::size_t>(a), static_cast<std::size_t>(b)), {candidate_});
    }
    return result.laid_pairs;
  };
  EXPECT_EQ(forgotten(three_), 0U);
  EXPECT_EQ(forgotten(laid("A", "", "")), 0U) << "beside nothing";
  EXPECT_EQ(forgotten(laid("A", "B", "")), 1U);
  EXPECT_EQ(forgotten(laid("A", "B", "")), 0U);
  EXPECT_EQ(run.fragments()[1].pose, "B");
  EXPECT_EQ(forgotten(laid("A", "B", "C")), 2U);
  EXPECT_EQ(forgotten(laid("A", "B", "D")), 2U);
  EXPECT_EQ(forgotten(laid("E", "", "D")), 3U) << "one otherwise, two no longer";
}

TEST_F(RunTest, DamagedDatabaseIsAnErrorNotACrash) {
  make_run();
  {
    std::fstream file(folder_ / kFileName, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(4096);
    file << std::string(6 * 4096, '\xff');
  }
  EXPECT_THROW(static_cast<void>(store::Run::open(folder_).pairs()), StoreError);
}

TEST_F(RunTest, AnySqliteToolReadsTheRankedView) {
  make_run();
  SQLite::Database database(folder_ / kFileName, SQLite::OPEN_READONLY);
  SQLite::Statement row(database, "SELECT a, b, score, verdict FROM ranked");
  ASSERT_TRUE(row.executeStep());
  EXPECT_EQ(row.getColumn(0).getString(), "a.ply");
  EXPECT_EQ(row.getColumn(3).getString(), "join");
}

}  // namespace
}  // namespace rejoin::store
