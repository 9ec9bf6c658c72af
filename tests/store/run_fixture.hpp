/// Runs of three fragments, one pair of which is done.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "store/run.hpp"

namespace rejoin::store {
namespace testing {
namespace fs = std::filesystem;

inline const Parameters kParameters{"0.1.0", R"({"resolution":128})", 0xffffffffffffffffULL};

inline Fragment fragment(const std::string& name, const std::string& hash) {
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
    candidate.slides = true;
    candidate.facet_a = 2;
    candidate.gap_median = 0.125;
    return candidate;
  }

  fs::path folder_;
  const std::vector<Fragment> three_ = {fragment("b.ply", "22"), fragment("a.ply", "11"),
                                        fragment("c.ply", "33")};
  const Candidate candidate_ = planted_candidate();
};

}  // namespace testing
}  // namespace rejoin::store
