#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace sunder::tools {

/// One line on stderr that fills up, drawn over itself; only where stderr is a terminal, only when
/// the work takes a while, at most ten times a second. Erased at the end.
class ProgressBar {
 public:
  explicit ProgressBar(std::size_t step_count);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Says that step number `step`, counted from zero, begins.
  void begin_step(std::size_t step, const std::string& what);

 private:
  using Clock = std::chrono::steady_clock;

  std::size_t step_count_;
  bool is_shown_;
  bool has_drawn_ = false;
  Clock::time_point next_draw_;
};

}  // namespace sunder::tools
