#include "store/run.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "core/error.hpp"

namespace rejoin::store {
namespace {
namespace fs = std::filesystem;

const Parameters kParameters{"0.1.0", R"({"resolution":128})", 0xffffffffffffffffULL};

using Changes = std::map<std::string, store::Run::Change>;

Fragment fragment(const std::string& name, const std::string& hash) {
  Fragment made;
  made.name = name;
  made.path = "somewhere/" + name;
  made.hash = hash;
  return made;
}

class RunTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "rejoin-store-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// The run's files in another folder, as they are while a writer has done a second pair and is stopped.
  fs::path stopped_run(const std::vector<std::string>& endings) const {
    make_run();
    store::Run run = store::Run::write(folder_);
    run.save(pair_of(run.fragments(), 1, 2), {candidate_});
    const fs::path copy = folder_ / "copy";
    fs::create_directory(copy);
    for (const std::string& ending : endings) {
      fs::copy_file(folder_ / (kFileName + ending), copy / (kFileName + ending));
      fs::permissions(copy / (kFileName + ending), fs::perms(0444));
    }
    return copy;
  }

  /// Number of the pairs that a user reads who may write nothing there; -1: refused.
  int pairs_without_writing(const fs::path& run) const {
    fs::permissions(folder_, fs::perms(0755));
    fs::permissions(run, fs::perms(0555));
    const pid_t reader = fork();
    if (reader == 0) {
      int count = -1;
      try {
        if (geteuid() == 0 && setuid(65534) != 0) _exit(254);  // root may write everywhere
        count = static_cast<int>(store::Run::open(run).pairs().size());
      } catch (const StoreError&) {
      }
      _exit(count < 0 ? 255 : count);
    }
    int status = 0;
    waitpid(reader, &status, 0);
    fs::permissions(run, fs::perms(0755));
    return WEXITSTATUS(status) == 255 ? -1 : WEXITSTATUS(status);
  }

  /// A run of b.ply, a.ply and c.ply with the pair (a, b) done.
  void make_run() const {
    store::Run run = store::Run::write(folder_);
    run.begin(kParameters, three_);
    run.save(pair_of(run.fragments(), 0, 1), {candidate_});
  }

  static Pair pair_of(const std::vector<Fragment>& list, std::size_t a, std::size_t b) {
    Pair pair;
    pair.a = list.at(a).id;
    pair.b = list.at(b).id;
    pair.stage = Stage::Match;
    pair.score = 0.75;
    pair.verdict = "join";
    pair.result = "{}";
    return pair;
  }

  static Candidate planted_candidate() {
    Candidate candidate;
    candidate.score = 0.75;
    candidate.pose = {axis_rotation(glm::normalize(glm::dvec3(1, 2, 3)), 0.7), {1.0 / 3.0, -2e9, 4e-9}};
    candidate.facet_a = 2;
    candidate.gap_median = 0.125;
    return candidate;
  }

  fs::path folder_;
  const std::vector<Fragment> three_ = {fragment("b.ply", "22"), fragment("a.ply", "11"),
                                        fragment("c.ply", "33")};
  const Candidate candidate_ = planted_candidate();
};

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

TEST_F(RunTest, SameInputsKeepEverything) {
  make_run();
  store::Run run = store::Run::write(folder_);
  const store::Run::Forgotten forgotten = run.begin(kParameters, three_);
  EXPECT_FALSE(forgotten.parameters);
  EXPECT_TRUE(forgotten.fragments.empty());
  EXPECT_EQ(run.done().size(), 1U);
}

TEST_F(RunTest, ChangedFragmentLosesItsPairsAlone) {
  make_run();
  store::Run run = store::Run::write(folder_);
  run.save(pair_of(run.fragments(), 0, 2), {});
  std::vector<Fragment> changed = three_;
  changed[0].hash = "44";  // b.ply
  changed[2].path = "elsewhere/c.ply";
  EXPECT_EQ(run.begin(kParameters, changed).fragments, (Changes{{"b.ply", store::Run::Change::Content}}));
  ASSERT_EQ(run.pairs().size(), 1U);
  EXPECT_EQ(run.pairs()[0].name_b, "c.ply");
  EXPECT_EQ(run.fragments()[2].path, "elsewhere/c.ply");
}

TEST_F(RunTest, FragmentThatCannotBeReadKeepsItsPairs) {
  make_run();
  store::Run run = store::Run::write(folder_);
  run.save(pair_of(run.fragments(), 0, 2), {});
  std::vector<Fragment> changed = three_;
  changed[0].hash = kUnreadable;
  EXPECT_EQ(run.begin(kParameters, changed).fragments, (Changes{{"b.ply", store::Run::Change::Unreadable}}));
  EXPECT_EQ(run.pairs().size(), 2U);
  EXPECT_TRUE(run.begin(kParameters, three_).fragments.empty());
  EXPECT_EQ(run.pairs().size(), 2U);
}

TEST_F(RunTest, FragmentThatIsGoneIsForgotten) {
  make_run();
  store::Run run = store::Run::write(folder_);
  EXPECT_EQ(run.begin(kParameters, {three_[0], three_[1]}).fragments,
            (Changes{{three_[2].name, store::Run::Change::Gone}}));
}

TEST_F(RunTest, FragmentPaintedOtherwiseLosesItsPairsAlone) {
  make_run();
  store::Run run = store::Run::write(folder_);
  run.save(pair_of(run.fragments(), 1, 2), {candidate_});
  std::vector<Fragment> painted = three_;
  painted[1].facets = "9a1d";  // a.ply
  EXPECT_EQ(run.begin(kParameters, painted).fragments, (Changes{{"a.ply", store::Run::Change::Paint}}));
  ASSERT_EQ(run.pairs().size(), 1U);
  EXPECT_EQ(run.pairs()[0].name_a, "b.ply");
  EXPECT_EQ(run.fragments()[0].facets, "9a1d");
  EXPECT_TRUE(run.begin(kParameters, painted).fragments.empty());
}

TEST_F(RunTest, CopyOfAnotherHasNoPairs) {
  make_run();  // with the pair of a.ply and b.ply
  std::vector<Fragment> list = three_;
  list.push_back(fragment("A.ply", "22"));  // the content of b.ply
  list.push_back(fragment("Copy of c.ply", "33"));
  list.push_back(fragment("d.ply", kUnreadable));
  list.push_back(fragment("e.ply", kUnreadable));
  EXPECT_EQ(copies(list),
            (std::map<std::string, std::string>{{"b.ply", "A.ply"}, {"Copy of c.ply", "c.ply"}}));
  store::Run run = store::Run::write(folder_);
  run.begin(kParameters, list);
  const std::map<std::string, std::string> kept{{"A.ply", "b.ply"}, {"Copy of c.ply", "c.ply"}};
  EXPECT_EQ(run.copies(), kept) << "b.ply has a pair";
  EXPECT_EQ(run.copies_among(list), kept);
  EXPECT_EQ(run.pairs().size(), 1U);
  Pair of_copy = pair_of(run.fragments(), 0, 1);  // A.ply and a.ply
  run.save(of_copy, {candidate_});
  run.begin(kParameters, list);
  ASSERT_EQ(run.pairs().size(), 1U) << "as many each: the shorter name, or the first";
  EXPECT_EQ(run.pairs()[0].name_a, "A.ply");
  list[0].hash = list[3].hash = "44";
  EXPECT_EQ(run.copies_among(list).at("b.ply"), "A.ply") << "pairs of an earlier content do not count";
}

TEST_F(RunTest, CopiesOfAShardAreChosenByNamesAlone) {
  store::Run run = store::Run::write(folder_);
  run.begin(kParameters, three_, "1/2");
  run.save(pair_of(run.fragments(), 0, 1), {candidate_});
  std::vector<Fragment> list = three_;
  list.push_back(fragment("A.ply", "22"));
  run.begin(kParameters, list, "1/2");
  EXPECT_EQ(run.copies(), (std::map<std::string, std::string>{{"b.ply", "A.ply"}}));
  EXPECT_TRUE(run.done().empty());
}

TEST_F(RunTest, GoneFragmentLosesItsPairs) {
  make_run();
  store::Run run = store::Run::write(folder_);
  run.begin(kParameters, {three_[0], three_[2]});
  EXPECT_EQ(run.fragments().size(), 2U);
  EXPECT_TRUE(run.done().empty());
}

TEST_F(RunTest, OtherScansAltogetherAreRefusedSoThatNoPairIsLost) {
  make_run();
  store::Run run = store::Run::write(folder_);
  EXPECT_THROW(run.begin(kParameters, {fragment("x.ply", "11"), fragment("y.ply", "22")}), StoreError);
  EXPECT_EQ(run.done().size(), 1U);
}

TEST_F(RunTest, OtherContentsUnderTheSameNamesAreRefusedSoThatNoPairIsLost) {
  make_run();
  store::Run run = store::Run::write(folder_);
  const std::vector<Fragment> others = {fragment("a.ply", "44"), fragment("b.ply", "55"),
                                        fragment("y.ply", "11")};
  EXPECT_THROW(run.begin(kParameters, others), StoreError);
  EXPECT_EQ(run.done().size(), 1U);
  run.begin(kParameters, {fragment("a.ply", "44"), three_[0]});
  EXPECT_TRUE(run.done().empty()) << "a.ply was scanned again, b.ply is the same";
  EXPECT_NO_THROW(run.begin(kParameters, others)) << "there is nothing to lose";
}

TEST_F(RunTest, AShardIsKeptFromOtherScansAndNotFromThoseOfItsFolder) {
  const std::vector<Fragment> elsewhere = {fragment("x.ply", "77"), fragment("y.ply", "88")};
  store::Run run = store::Run::write(folder_);
  run.begin(kParameters, three_, "1/2");
  run.save(pair_of(run.fragments(), 0, 1), {candidate_});
  EXPECT_THROW(run.begin(kParameters, elsewhere, "1/2"), StoreError);
  EXPECT_THROW(run.begin(kParameters, elsewhere, "1/2", {fragment("a.ply", "99")}), StoreError)
      << "another content of the same name";
  EXPECT_THROW(run.begin(kParameters, {fragment("a.ply", "44"), fragment("b.ply", "55")}, "1/2"), StoreError);
  EXPECT_EQ(run.done().size(), 1U);
  EXPECT_NO_THROW(run.begin(kParameters, elsewhere, "1/2", {three_[1]})) << "scans came before a.ply";
  EXPECT_TRUE(run.done().empty());
}

TEST_F(RunTest, RefusalNamesAScanOfTheSameName) {
  make_run();
  store::Run run = store::Run::write(folder_);
  try {
    run.begin(kParameters, {fragment("b.ply", "55"), fragment("y.ply", "44")});
    FAIL();
  } catch (const StoreError& error) {
    EXPECT_NE(std::string(error.what()).find("same names: b.ply and 0 more"), std::string::npos)
        << error.what();
  }
}

TEST_F(RunTest, ScansThatCannotBeReadAreNotToldToBeOthers) {
  make_run();
  store::Run run = store::Run::write(folder_);
  std::vector<Fragment> away = three_;
  for (Fragment& scan : away) scan.hash = kUnreadable;
  try {
    run.begin(kParameters, away);
    FAIL();
  } catch (const StoreError& error) {
    const std::string told = error.what();
    EXPECT_NE(told.find("none of its scans can be read as it was: a.ply and 2 more"), std::string::npos)
        << told;
    EXPECT_NE(told.find("mount the disk"), std::string::npos) << told;
    EXPECT_EQ(told.find("remove"), std::string::npos) << told;
  }
  EXPECT_EQ(run.done().size(), 1U);
}

TEST_F(RunTest, ScansThatWereAllUnreadableMayAllChange) {
  make_run();
  store::Run run = store::Run::write(folder_);
  Pair failed = run.pairs().at(0);
  failed.stage = Stage::Failed;
  run.save(failed, {});
  EXPECT_NO_THROW(run.begin(kParameters, {fragment("a.ply", "44"), fragment("b.ply", "55")}));
}

TEST_F(RunTest, ChangedParametersForgetAllPairs) {
  make_run();
  store::Run run = store::Run::write(folder_);
  Parameters other = kParameters;
  other.seed = 2;
  EXPECT_TRUE(run.begin(other, three_).parameters);
  EXPECT_TRUE(run.done().empty());
  EXPECT_EQ(run.parameters().seed, 2U);
}

TEST_F(RunTest, OtherShardIsRefusedSoThatNoPairIsLost) {
  make_run();
  store::Run run = store::Run::write(folder_);
  EXPECT_THROW(run.begin(kParameters, three_, "1/8"), StoreError);
  EXPECT_EQ(run.done().size(), 1U);
  EXPECT_EQ(run.shard(), "");
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
  EXPECT_TRUE(run.done()[1].failed);
  run.forget_failures();
  ASSERT_EQ(run.done().size(), 1U);
  EXPECT_FALSE(run.done()[0].failed);
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
            "ALTER TABLE fragment DROP COLUMN facets; PRAGMA user_version = 1");
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
        "PRAGMA user_version = 2");
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
