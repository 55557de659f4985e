#pragma once

#include <sunder/scene/scene.h>

#include <deque>
#include <functional>
#include <memory>

#include "core/internal/threads.h"
#include "scene/threads/once_job.h"

namespace sunder::scene {

/// Runs jobs in the background, one after the other: by the hook of the caller, or on a thread that
/// starts with the first job. Without threads and hook they run at once.
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
  Mutex mutex_;
  Condition is_called_;
  std::deque<std::function<void()>> jobs_;
  bool is_stopping_ = false;
  Thread thread_;
};

}  // namespace sunder::scene
