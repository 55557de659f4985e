// The threads of a scene, and tasks that throw.

#include "scene/threads/thread_pool.h"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace sunder::scene {
namespace {

/// Tasks, of which one throws, at once or after the others began.
struct Work {
  std::uint32_t throws_at = 0;
  std::thread::id caller;
  bool throws_on_caller = false;  ///< Instead of at an index.
  std::atomic<int> running{0}, done{0};
};

void run_task(const void* of, std::uint32_t index) {
  Work& work = *static_cast<Work*>(const_cast<void*>(of));
  ++work.running;
  const bool is_caller = std::this_thread::get_id() == work.caller;
  if (work.throws_on_caller ? is_caller : index == work.throws_at) {
    --work.running;
    throw std::runtime_error("a hook failed");
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  --work.running;
  ++work.done;
}

/// @return the tasks that ran to their end.
int run_and_expect_throw(ThreadPool& pool, Work& work, std::uint32_t count) {
  work.caller = std::this_thread::get_id();
  const ParallelFor hook = pool.parallel_for();
  EXPECT_THROW(hook.run(hook.context, count, run_task, &work), std::runtime_error);
  EXPECT_EQ(work.running, 0) << "a thread still works on what the caller may free";
  return work.done;
}

TEST(ThreadPool, joins_before_an_exception_of_the_caller_leaves) {
  ThreadPool pool(4);
  for (int run = 0; run < 20; ++run) {
    Work work;
    work.throws_on_caller = true;
    EXPECT_LE(run_and_expect_throw(pool, work, 64), 63);
  }
}

TEST(ThreadPool, hands_over_the_exception_of_a_worker) {
  ThreadPool pool(4);
  for (std::uint32_t at = 0; at < 4; ++at) {
    Work work;
    work.throws_at = at;
    EXPECT_LT(run_and_expect_throw(pool, work, 64), 64);
  }
}

TEST(ThreadPool, works_again_after_an_exception) {
  ThreadPool pool(3);
  Work failing;
  (void)run_and_expect_throw(pool, failing, 8);
  Work work;
  work.throws_at = ~0u;
  const ParallelFor hook = pool.parallel_for();
  hook.run(hook.context, 8, run_task, &work);
  EXPECT_EQ(work.done, 8);
}

TEST(ThreadPool, a_single_thread_throws_at_once) {
  ThreadPool pool(1);
  Work work;
  work.throws_at = 2;
  EXPECT_EQ(run_and_expect_throw(pool, work, 8), 2);
}

}  // namespace
}  // namespace sunder::scene
