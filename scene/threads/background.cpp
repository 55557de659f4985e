#include "scene/threads/background.h"

#include <sunder/core/memory_scope.h>

#include <utility>

#include "core/internal/threads.h"

namespace sunder::scene {

Background::~Background() {
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
  }
  is_called_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Background::start(std::function<void()> work) {
  std::function<void()> job = [work = std::move(work), memory = MemoryScope::current()] {
    const MemoryScope scope(memory);
    work();
  };
  if (hook_.run != nullptr) {
    auto held = std::make_unique<std::function<void()>>(std::move(job));
    const auto run = [](void* data) {
      const std::unique_ptr<std::function<void()>> of(static_cast<std::function<void()>*>(data));
      (*of)();
    };
    hook_.run(hook_.context, run, held.release());
    return;
  }
  if (!kHasThreads) {
    job();
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    if (!thread_.joinable()) thread_ = Thread([this] { serve(); });
    jobs_.push_back(std::move(job));
  }
  is_called_.notify_one();
}

void Background::serve() {
  std::unique_lock lock(mutex_);
  for (;;) {
    is_called_.wait(lock, [this] { return is_stopping_ || !jobs_.empty(); });
    if (is_stopping_) return;
    std::function<void()> job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    job();
    job = nullptr;  // what it held may take time to free
    lock.lock();
  }
}

}  // namespace sunder::scene
