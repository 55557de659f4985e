#pragma once

#include <sunder/core/parallel_for.h>

#include <cstdint>
#include <thread>
#include <vector>

namespace sunder::test {

/// Runs tasks from the last to the first, as if on a given number of threads.
struct BackwardThreads {
  std::uint32_t threads;
  std::uint32_t calls = 0;
  ParallelFor hook() { return {&BackwardThreads::run, this, threads}; }
  static void run(void* context, std::uint32_t count, ParallelFor::Task task, const void* work) {
    BackwardThreads& self = *static_cast<BackwardThreads*>(context);
    ++self.calls;
    std::vector<std::thread> running;
    for (std::uint32_t t = 0; t < self.threads; ++t)
      running.emplace_back([&, t] {
        for (std::uint32_t i = count; i-- > 0;)
          if (i % self.threads == t) task(work, i);
      });
    for (std::thread& thread : running) thread.join();
  }
};

}  // namespace sunder::test
