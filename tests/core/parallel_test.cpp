#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace rejoin {
namespace {

TEST(SideBySide, EveryJobRunsOnce) {
  std::vector<std::atomic<int>> runs(1000);
  run_side_by_side(runs.size(), [&](std::size_t k) { ++runs[k]; });
  for (const auto& count : runs) EXPECT_EQ(count, 1);
  run_side_by_side(0, [](std::size_t) { FAIL(); });
}

TEST(SideBySide, LoopsInsideAJobStayOnItsThread) {
  const ThreadLimit limit(4);
  std::atomic<int> strangers{0};
  run_side_by_side(8, [&](std::size_t) {
    const auto mine = std::this_thread::get_id();
    parallel_for(200, 1, [&](std::size_t, std::size_t) {
      if (std::this_thread::get_id() != mine) ++strangers;
    });
  });
  EXPECT_EQ(strangers, 0);
}

TEST(SideBySide, OneThreadKeepsTheOrder) {
  const ThreadLimit limit(1);
  std::vector<std::size_t> order;
  run_side_by_side(50, [&](std::size_t k) { order.push_back(k); });
  ASSERT_EQ(order.size(), 50U);
  for (std::size_t k = 0; k < order.size(); ++k) EXPECT_EQ(order[k], k);
}

TEST(SideBySide, ExceptionEndsTheJobsOfItsThreadAndComesOut) {
  const ThreadLimit limit(1);
  std::size_t started = 0;
  EXPECT_THROW(run_side_by_side(100,
                                [&](std::size_t k) {
                                  ++started;
                                  if (k == 3) throw std::runtime_error("job 3");
                                }),
               std::runtime_error);
  EXPECT_EQ(started, 4U);
}

TEST(SideBySide, ExceptionEndsTheJobsOfOtherThreads) {
  const ThreadLimit limit(2);
  std::atomic<std::size_t> started{0};
  EXPECT_THROW(run_side_by_side(10000,
                                [&](std::size_t k) {
                                  ++started;
                                  if (k == 3) throw std::runtime_error("job 3");
                                  // The other thread cannot run all jobs while this one waits for a core.
                                  std::this_thread::sleep_for(std::chrono::milliseconds(1));
                                }),
               std::runtime_error);
  EXPECT_LT(started, 10000U);
}

}  // namespace
}  // namespace rejoin
