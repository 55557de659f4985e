#include "scene/threads/thread_pool.h"

#include <utility>

#include "core/internal/threads.h"

namespace sunder::scene {

ThreadPool::ThreadPool(std::uint32_t threads) {
  try {
    threads_.reserve(threads);
    while (kHasThreads && threads_.size() + 1 < threads) threads_.emplace_back([this] { serve(); });
  } catch (...) {
    stop();
    throw;
  }
}

ThreadPool::~ThreadPool() { stop(); }

void ThreadPool::stop() noexcept {
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
  }
  is_called_.notify_all();
  for (Thread& thread : threads_) thread.join();
}

ParallelFor ThreadPool::parallel_for() {
  ParallelFor hook;
  hook.context = this;
  hook.threads = static_cast<std::uint32_t>(threads_.size()) + 1;
  hook.run = [](void* context, std::uint32_t count, ParallelFor::Task task, const void* work) {
    static_cast<ThreadPool*>(context)->run({task, work, count});
  };
  return hook;
}

void ThreadPool::work_on(const Job& job) noexcept {
  try {
    for (std::uint32_t i = next_.fetch_add(1); i < job.count; i = next_.fetch_add(1))
      job.task(job.work, i);
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (thrown_ == nullptr) thrown_ = std::current_exception();
    next_ = job.count;
  }
}

void ThreadPool::run(const Job& job) {
  if (job.count <= 1 || threads_.empty()) {
    for (std::uint32_t i = 0; i < job.count; ++i) job.task(job.work, i);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    job_ = job;
    next_ = 0;
    ++call_;
  }
  is_called_.notify_all();
  work_on(job);
  std::unique_lock lock(mutex_);
  job_.count = 0;  // a thread that wakes up late finds nothing to do
  is_done_.wait(lock, [this] { return busy_ == 0; });
  if (std::exception_ptr thrown = std::exchange(thrown_, nullptr)) std::rethrow_exception(thrown);
}

void ThreadPool::serve() {
  std::uint64_t seen = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    is_called_.wait(lock, [&] { return is_stopping_ || call_ != seen; });
    if (is_stopping_) return;
    seen = call_;
    const Job job = job_;
    if (job.count == 0) continue;
    ++busy_;
    lock.unlock();
    work_on(job);
    lock.lock();
    if (--busy_ == 0) is_done_.notify_one();
  }
}

}  // namespace sunder::scene
