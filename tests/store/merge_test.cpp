#include "store/merge.hpp"

#include <SQLiteCpp/Database.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "core/error.hpp"
#include "store/run.hpp"

namespace rejoin::store {
namespace {
namespace fs = std::filesystem;

const Parameters kShardParameters{"0.1.0", "{}", 3};

class Merge : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "rejoin-merge-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A shard that knows these fragments and has done the pair of the first two, with two candidates.
  fs::path shard(const std::string& name, const std::vector<std::string>& fragments, double score,
                 const Parameters& parameters = kShardParameters, const std::string& hash = "1",
                 const std::string& pose = "") const {
    fs::create_directories(folder_ / name);
    store::Run run = store::Run::write(folder_ / name);
    std::vector<Fragment> list(fragments.size());
    for (std::size_t k = 0; k < fragments.size(); ++k) {
      list[k].name = fragments[k];
      list[k].path = "scans/" + fragments[k];
      list[k].hash = hash + fragments[k];
      list[k].pose = pose;
    }
    run.begin(parameters, list, name);
    std::vector<Fragment> known = run.fragments();
    known[0].state = FragmentState::Ready;
    known[0].faces = 17;
    run.save(known[0]);
    Pair pair;
    pair.a = known[0].id;
    pair.b = known[1].id;
    pair.stage = Stage::Match;
    pair.score = score;
    pair.result = "{}";
    Candidate best;
    best.score = score;
    run.save(pair, {best, Candidate()});
    return folder_ / name;
  }

  /// A shard that could not use the first fragment.
  fs::path failed_shard(const std::string& name, const std::vector<std::string>& fragments) const {
    shard(name, fragments, 0);
    store::Run run = store::Run::write(folder_ / name);
    Fragment bad = run.fragments()[0];
    bad.state = FragmentState::Bad;
    bad.error = "a: out of memory";
    run.save(bad);
    Pair failed = run.pairs().at(0);
    failed.stage = Stage::Failed;
    failed.error = bad.error;
    run.save(failed, {});
    return folder_ / name;
  }

  fs::path output() const { return folder_ / "whole"; }

  fs::path folder_;
};

TEST_F(Merge, WholeHasEveryPairUnderItsNames) {
  const Merged merged = merge({shard("x", {"c", "d"}, 0.5), shard("y", {"a", "b", "c"}, 0.75)}, output());
  EXPECT_EQ(merged.fragments, 4U);
  EXPECT_EQ(merged.pairs, 2U);
  const store::Run whole = store::Run::open(output());
  EXPECT_EQ(whole.parameters(), kShardParameters);
  EXPECT_EQ(whole.shard(), "");
  const std::vector<Pair> pairs = whole.pairs();
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].name_a + pairs[0].name_b, "ab");
  EXPECT_EQ(pairs[1].name_a + pairs[1].name_b, "cd");
  EXPECT_EQ(whole.candidates(pairs[1]).size(), 2U);
  EXPECT_EQ(whole.candidates(pairs[1])[0].score, 0.5);
}

TEST_F(Merge, FragmentsAreNumberedByNameAndTakenFromWhoLookedAtThem) {
  merge({shard("x", {"b", "c"}, 0.5), shard("y", {"c", "d"}, 0.5)}, output());
  const std::vector<Fragment> fragments = store::Run::open(output()).fragments();
  ASSERT_EQ(fragments.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(fragments[k].id, static_cast<std::int64_t>(k + 1));
  EXPECT_EQ(fragments[1].state, FragmentState::Ready) << "the first shard did not look at c, the second did";
  EXPECT_EQ(fragments[1].faces, 17);
}

TEST_F(Merge, ShardsOfEarlierSchemasAreTakenWithTheirCandidates) {
  const fs::path x = shard("x", {"a", "b"}, 0.5);
  const fs::path y = shard("y", {"c", "d"}, 0.75);
  const auto make_earlier = [&](const std::string& change) {
    for (const fs::path& run : {x, y}) SQLite::Database(run / kFileName, SQLite::OPEN_READWRITE).exec(change);
  };
  for (const char* change :
       {"ALTER TABLE candidate DROP COLUMN slides; PRAGMA user_version = 3",
        "ALTER TABLE fragment DROP COLUMN pose; ALTER TABLE fragment DROP COLUMN facets; "
        "PRAGMA user_version = 2",
        "ALTER TABLE fragment DROP COLUMN spacing; ALTER TABLE fragment DROP COLUMN noise; "
        "ALTER TABLE fragment DROP COLUMN wall; PRAGMA user_version = 1"}) {
    make_earlier(change);
    EXPECT_EQ(merge({x, y}, output()).pairs, 2U) << change;
    const store::Run whole = store::Run::open(output());
    ASSERT_EQ(whole.candidates(3, 4).size(), 2U) << change;
    EXPECT_EQ(whole.candidates(3, 4)[0].score, 0.75) << change;
    EXPECT_FALSE(whole.candidates(3, 4)[0].slides) << change;
  }
}

TEST_F(Merge, PairThatTwoShardsHaveIsTakenOnce) {
  const Merged merged = merge({shard("x", {"a", "b"}, 0.5), shard("y", {"a", "b"}, 0.5)}, output());
  EXPECT_EQ(merged.pairs, 1U);
  EXPECT_EQ(store::Run::open(output()).candidates(1, 2).size(), 2U);
}

TEST_F(Merge, ResultOfOneRunOutlivesTheFailureOfAnother) {
  const fs::path good = shard("x", {"a", "b"}, 0.5);
  const fs::path bad = failed_shard("y", {"a", "b"});
  for (const std::vector<fs::path>& runs : {std::vector{good, bad}, std::vector{bad, good}}) {
    EXPECT_EQ(merge(runs, output()).failed, 0U);
    const store::Run whole = store::Run::open(output());
    EXPECT_EQ(whole.pairs().at(0).score, 0.5);
    EXPECT_EQ(whole.candidates(1, 2).size(), 2U);
    EXPECT_EQ(whole.fragments()[0].state, FragmentState::Ready);
  }
  EXPECT_THROW(merge({bad}, output()), StoreError) << "the output's result would be lost";
  EXPECT_EQ(store::Run::open(output()).candidates(1, 2).size(), 2U);
}

TEST_F(Merge, PairSearchedInFullByOneRunIsTakenInWhateverOrder) {
  const fs::path full = shard("x", {"a", "b"}, 0.5);
  const fs::path early = shard("y", {"a", "b"}, 0.25);
  {
    store::Run run = store::Run::write(early);
    Pair pair = run.pairs().at(0);
    pair.stage = Stage::Sweep;
    run.save(pair, {Candidate(), Candidate(), Candidate()});
  }
  for (const std::vector<fs::path>& runs : {std::vector{full, early}, std::vector{early, full}}) {
    merge(runs, output());
    const store::Run whole = store::Run::open(output());
    EXPECT_EQ(whole.pairs().at(0).stage, Stage::Match);
    EXPECT_EQ(whole.pairs().at(0).score, 0.5);
    EXPECT_EQ(whole.candidates(1, 2).size(), 2U);
  }
}

TEST_F(Merge, WhatAnInterruptedOneLeftIsNoDatabase) {
  fs::create_directories(output());
  std::ofstream(output() / kFileName);
  std::ofstream(output() / "run.sqlite-wal") << "of a database that was there before";
  merge({shard("x", {"a", "b"}, 0.5), shard("y", {"c", "d"}, 0.5)}, output());
  EXPECT_EQ(store::Run::open(output()).pairs().size(), 2U);
  EXPECT_EQ(store::Run::write(output()).pairs().size(), 2U);
}

TEST_F(Merge, WholeReplacesWhatWasThereButLosesNoPair) {
  const fs::path x = shard("x", {"a", "b"}, 0.5);
  const fs::path y = shard("y", {"c", "d"}, 0.5);
  merge({x}, output());
  merge({x, y}, output());
  EXPECT_EQ(store::Run::open(output()).pairs().size(), 2U);
  EXPECT_FALSE(fs::exists(output() / "merge.part"));
  EXPECT_THROW(merge({y}, output()), StoreError);
  EXPECT_FALSE(fs::exists(output() / "merge.part"));
  EXPECT_EQ(store::Run::open(output()).pairs().size(), 2U);
}

TEST_F(Merge, AllShardsForgetTheScansThatAreGone) {
  merge({shard("1/2", {"a", "b", "c", "d"}, 0.5), shard("2/2", {"a", "d"}, 0.5)}, output());
  fs::remove_all(folder_ / "1");
  fs::remove_all(folder_ / "2");
  const fs::path first = shard("1/2", {"a", "b", "c"}, 0.5);
  EXPECT_THROW(merge({first}, output()), StoreError) << "the other shard may know d";
  const Merged merged = merge({first, shard("2/2", {"b", "c"}, 0.5)}, output());
  EXPECT_EQ(merged.gone, std::vector<std::string>{"d"});
  const std::vector<Pair> pairs = store::Run::open(output()).pairs();
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].name_a + pairs[0].name_b, "ab");
  EXPECT_EQ(pairs[1].name_a + pairs[1].name_b, "bc");
  // What remains must still be there.
  fs::remove_all(folder_ / "2");
  EXPECT_THROW(merge({first, shard("2/2", {"a", "c"}, 0.5)}, output()), StoreError);
}

TEST_F(Merge, ReaderGoesOnReadingTheOldWholeAndTheNewOneStays) {
  const fs::path x = shard("x", {"a", "b"}, 0.5);
  merge({x}, output());
  {
    // Writes go to the journal, which stays as long as there is a reader.
    const store::Run reader = store::Run::open(output());
    store::Run::write(output()).begin(kShardParameters, reader.fragments());
    merge({x, shard("y", {"c", "d"}, 0.5)}, output());
    EXPECT_EQ(reader.pairs().size(), 1U);
    EXPECT_EQ(store::Run::open(output()).pairs().size(), 2U);
  }
  EXPECT_EQ(store::Run::open(output()).pairs().size(), 2U);
}

TEST_F(Merge, OutputThatAnotherProcessWritesIsRefused) {
  const fs::path x = shard("x", {"a", "b"}, 0.5);
  merge({x}, output());
  const store::Run writer = store::Run::write(output());
  EXPECT_THROW(merge({x}, output()), StoreError);
}

TEST_F(Merge, WholeCanBeOneOfItsParts) {
  merge({shard("x", {"a", "b"}, 0.5)}, output());
  EXPECT_EQ(merge({output(), shard("y", {"c", "d"}, 0.5)}, output()).pairs, 2U);
}

TEST_F(Merge, CopyThatCameLaterTakesNoPairs) {
  const fs::path x = shard("x", {"a", "bb"}, 0.5);
  merge({x}, output());
  const auto add_copy = [](const fs::path& run, const std::string& shard) {
    store::Run with_copy = store::Run::write(run);
    std::vector<Fragment> list = with_copy.fragments();
    list.push_back(list[1]);
    list.back().name = "b";
    with_copy.begin(kShardParameters, list, shard);
  };
  add_copy(output(), "");
  const Merged itself = merge({output()}, output());
  EXPECT_EQ(itself.pairs, 1U);
  EXPECT_EQ(store::Run::open(output()).pairs().at(0).name_b, "bb");
  // Shards choose by names alone and search the copy's pairs again: those of its other name are no loss then.
  add_copy(x, "x");
  EXPECT_THROW(merge({x}, output()), StoreError) << "not searched yet";
  store::Run run = store::Run::write(x);
  Pair pair;
  pair.a = run.fragments().at(0).id;
  pair.b = run.fragments().at(1).id;
  pair.stage = Stage::Match;
  pair.result = "{}";
  run.save(pair, {});
  EXPECT_EQ(merge({x}, output()).pairs, 1U);
  EXPECT_EQ(store::Run::open(output()).pairs().at(0).name_b, "b");
}

TEST_F(Merge, ShardStaysAShard) {
  const fs::path x = shard("x", {"a", "b"}, 0.5);
  EXPECT_THROW(merge({x}, x), StoreError);
  EXPECT_THROW(merge({x, shard("y", {"c", "d"}, 0.5)}, x), StoreError);
  EXPECT_EQ(store::Run::open(x).shard(), "x");
}

TEST_F(Merge, SameRunTwiceIsRefused) {
  const fs::path x = shard("x", {"a", "b"}, 0.5);
  EXPECT_THROW(merge({x, folder_ / "." / "x" / kFileName}, output()), StoreError);
  EXPECT_FALSE(fs::exists(output()));
}

TEST_F(Merge, OtherParametersOrContentsAreRefusedAndNothingIsWritten) {
  Parameters other = kShardParameters;
  other.seed = 4;
  const fs::path x = shard("x", {"a", "b"}, 0.5);
  EXPECT_THROW(merge({x, shard("y", {"a", "c"}, 0.5, other)}, output()), StoreError);
  EXPECT_THROW(merge({x, shard("z", {"a", "c"}, 0.5, kShardParameters, "2")}, output()), StoreError);
  EXPECT_THROW(merge({x, shard("w", {"a", "c"}, 0.5, kShardParameters, "1", "laid")}, output()), StoreError);
  EXPECT_THROW(merge({x, folder_ / "nowhere"}, output()), StoreError);
  EXPECT_FALSE(fs::exists(output()));
}

}  // namespace
}  // namespace rejoin::store
