/// Threads for data-parallel loops (oneTBB behind it).
#pragma once

#include <cstddef>
#include <functional>

namespace rejoin {

/// Limits the number of threads of all parallel loops while it lives.  threads <= 0: all cores.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_;
};

/// Runs body(first, last) on pieces of 0 .. count - 1 of at least `grain` items.  The split may depend on the number of
/// threads, so body must write only to slots of its own items: results are then the same for any number of threads.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t first, std::size_t last)>& body);

/// Runs job(k) for k = 0 .. count - 1, started in this order, as many side by side as thread_count() allows.  Each job has one
/// thread: parallel loops inside it run on that alone, so jobs do not wait for each other.  After an exception no further job
/// starts; it is thrown again once those that run have ended.
void run_side_by_side(std::size_t count, const std::function<void(std::size_t job)>& job);

/// Number of threads that a loop may use now.
int thread_count();

}  // namespace rejoin
