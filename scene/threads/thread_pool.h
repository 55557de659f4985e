#pragma once

#include <sunder/core/parallel_for.h>

#include <atomic>
#include <cstdint>
#include <exception>
#include <vector>

#include "core/internal/threads.h"

namespace sunder::scene {

/// Threads that share the tasks of one call at a time with the thread that makes it. If a task
/// throws, no further one begins, all threads leave the job, and then the call throws the first
/// exception.
class ThreadPool {
 public:
  /// @param threads  number of threads that work, with the calling one. @throws std::system_error,
  ///        std::bad_alloc
  explicit ThreadPool(std::uint32_t threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] ParallelFor parallel_for();

 private:
  struct Job {
    ParallelFor::Task task = nullptr;
    const void* work = nullptr;
    std::uint32_t count = 0;
  };
  void run(const Job& job);
  void work_on(const Job& job) noexcept;
  void serve();
  void stop() noexcept;

  Mutex mutex_;
  Condition is_called_, is_done_;
  Job job_;
  std::uint64_t call_ = 0;  ///< Number of the job.
  std::uint32_t busy_ = 0;  ///< Threads of the pool that work on it.
  bool is_stopping_ = false;
  std::exception_ptr thrown_;           ///< By a task of the job.
  std::atomic<std::uint32_t> next_{0};  ///< The next task of the job.
  std::vector<Thread> threads_;
};

}  // namespace sunder::scene
