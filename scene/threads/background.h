#pragma once

#include <sunder/scene/scene.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "scene/threads/once_job.h"

namespace sunder::scene {

/// Runs jobs in the background, one after the other: by the hook of the caller, or on a thread that
/// starts with the first job.
class Background {
 public:
  /// @param updates  see SceneOptions::background_updates.
  Background(const BackgroundHook& hook, std::uint32_t updates) : hook_(hook), updates_(updates) {}
  /// Waits for the job under way on the own thread; later ones are dropped.
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Thread-safe. @param work  owns what it uses. @throws std::bad_alloc, std::system_error
  void start(std::function<void()> work);
  /// When work that begins now takes effect.
  [[nodiscard]] SwapTime swap_time() const { return SwapTime(updates_); }

 private:
  void serve();

  BackgroundHook hook_;
  std::uint32_t updates_;
  std::mutex mutex_;
  std::condition_variable is_called_;
  std::deque<std::function<void()>> jobs_;
  bool is_stopping_ = false;
  std::thread thread_;
};

}  // namespace sunder::scene
