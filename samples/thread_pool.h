#pragma once

#include <sunder/core/parallel_for.h>

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace samples {

/// A plain thread pool for sunder::ParallelFor. An idle worker polls for some time before it
/// sleeps: the next call of a frame comes soon, and waking a thread takes longer than posing a few
/// thousand vertices.
class ThreadPool {
 public:
  /// @param threads  number of threads, including the calling one.
  explicit ThreadPool(std::uint32_t threads) {
    for (std::uint32_t i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
  }

  ~ThreadPool() {
    ends_ = true;
    publish(0);
    for (std::thread& worker : workers_) worker.join();
  }

  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] sunder::ParallelFor hook() {
    return {&ThreadPool::run, this, static_cast<std::uint32_t>(workers_.size()) + 1};
  }

 private:
  static constexpr int kLooks = 20'000;  // some 50 microseconds

  static void run(void* context, std::uint32_t count, sunder::ParallelFor::Task task,
                  const void* work) {
    ThreadPool& pool = *static_cast<ThreadPool*>(context);
    pool.task_ = task;
    pool.work_ = work;
    pool.done_ = 0;
    pool.publish(count);
    pool.take_part();
    while (pool.done_.load(std::memory_order_acquire) < count) std::this_thread::yield();
  }

  /// A ticket holds the number of remaining tasks in its low half and the index of the job in its
  /// high half, so that a late worker notices that its job is over and discards what it read of it.
  void publish(std::uint32_t count) {
    const std::uint64_t job = (tickets_.load() >> 32u) + 1;
    tickets_.store(job << 32u | count);
    if (sleepers_.load() > 0) tickets_.notify_all();
  }

  ///
  /// @return whether there was a task.
  bool take_part() {
    bool worked = false;
    for (std::uint64_t tickets = tickets_.load(); (tickets & 0xFFFF'FFFFu) > 0;) {
      const auto task = task_.load();
      const void* work = work_.load();
      if (!tickets_.compare_exchange_weak(tickets, tickets - 1)) continue;
      task(work, static_cast<std::uint32_t>(tickets & 0xFFFF'FFFFu) - 1);
      done_.fetch_add(1, std::memory_order_release);
      worked = true;
      tickets = tickets_.load();
    }
    return worked;
  }

  void work() {
    for (int looks = 0; !ends_.load();) {
      if (take_part()) looks = 0;
      if (++looks < kLooks) continue;
      const std::uint64_t seen = tickets_.load();
      if ((seen & 0xFFFF'FFFFu) > 0 || ends_.load()) continue;
      ++sleepers_;
      tickets_.wait(seen);
      --sleepers_;
      looks = 0;
    }
  }

  std::atomic<std::uint64_t> tickets_ = 0;
  std::atomic<sunder::ParallelFor::Task> task_ = nullptr;
  std::atomic<const void*> work_ = nullptr;
  std::atomic<std::uint32_t> done_ = 0, sleepers_ = 0;
  std::atomic<bool> ends_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace samples
