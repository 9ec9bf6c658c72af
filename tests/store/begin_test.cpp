/// What a run keeps and forgets when inputs or parameters change.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "run_fixture.hpp"
#include "store/run.hpp"

namespace rejoin::store {
namespace {
using testing::fragment;
using testing::kParameters;
using testing::RunTest;

using Changes = std::map<std::string, store::Run::Change>;

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

TEST_F(RunTest, AShardIsKeptFromOtherScans) {
  const std::vector<Fragment> elsewhere = {fragment("x.ply", "77"), fragment("y.ply", "88")};
  store::Run run = store::Run::write(folder_);
  run.begin(kParameters, three_, "1/2");
  run.save(pair_of(run.fragments(), 0, 1), {candidate_});
  EXPECT_THROW(run.begin(kParameters, elsewhere, "1/2"), StoreError);
  EXPECT_THROW(run.begin(kParameters, {fragment("a.ply", "44"), fragment("b.ply", "55")}, "1/2"), StoreError);
  EXPECT_EQ(run.done().size(), 1U);
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

}  // namespace
}  // namespace rejoin::store
