#pragma once

#include <sunder/scene/scene.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

namespace sunder::scene {

/// Runs jobs in the background, one after the other: by the hook of the caller, or on a thread that
/// starts with the first job.
class Background {
 public:
  explicit Background(const BackgroundHook& hook) : hook_(hook) {}
  /// Waits for the job under way on the own thread; later ones are dropped.
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Thread-safe. @param job  owns what it uses. @throws std::bad_alloc, std::system_error
  void start(std::function<void()> job);

 private:
  void serve();

  BackgroundHook hook_;
  std::mutex mutex_;
  std::condition_variable is_called_;
  std::deque<std::function<void()>> jobs_;
  bool is_stopping_ = false;
  std::thread thread_;
};

}  // namespace sunder::scene
