#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <utility>

namespace sunder::scene {

/// Work that runs once: in the background, or on the thread that needs its result first.
class OnceJob {
 public:
  /// @param work  throws nothing.
  explicit OnceJob(std::function<void()> work) : work_(std::move(work)) {}

  /// Runs the work, unless another thread has begun it.
  void run() {
    State expected = State::waiting;
    if (!state_.compare_exchange_strong(expected, State::running)) return;
    work_();
    state_ = State::done;
    state_.notify_all();
  }
  /// Returns when the work is done.
  void finish() {
    run();
    state_.wait(State::running);
  }
  [[nodiscard]] bool is_done() const { return state_ == State::done; }

 private:
  enum class State { waiting, running, done };
  std::function<void()> work_;
  std::atomic<State> state_ = State::waiting;
};

/// When work in the background takes effect.
class SwapTime {
 public:
  /// @param updates  exactly so many after the one that begins the work; 0: as soon as it is done.
  explicit SwapTime(std::uint32_t updates) : updates_(updates) {}

  /// Called once in each later update. @return whether the result is to be taken in it; it is done
  /// then.
  [[nodiscard]] bool has_come(OnceJob& job) {
    if (updates_ == 0) return job.is_done();
    if (++age_ < updates_) return false;
    job.finish();
    return true;
  }

 private:
  std::uint32_t updates_, age_ = 0;
};

}  // namespace sunder::scene
