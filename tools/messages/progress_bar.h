#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace sunder::tools {

/// A progress bar of one line on stderr, erased at the end. It is drawn only if stderr is a
/// terminal and the work takes longer than 300 ms, at most ten times a second.
class ProgressBar {
 public:
  explicit ProgressBar(std::size_t step_count);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows that step number `step`, counted from zero, begins.
  void begin_step(std::size_t step, const std::string& what);

 private:
  using Clock = std::chrono::steady_clock;

  std::size_t step_count_;
  bool is_shown_;
  Clock::time_point next_draw_;
};

/// Erases a drawn bar, so that a message can take its line. The next step draws it again.
void erase_progress_bar();

}  // namespace sunder::tools
