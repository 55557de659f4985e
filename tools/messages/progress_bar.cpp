#include "tools/messages/progress_bar.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <unistd.h>

#include "tools/messages/visible.h"

namespace sunder::tools {
namespace {

using namespace std::chrono_literals;
constexpr std::size_t kWidth = 30;
std::atomic<bool> is_on_the_line = false;  ///< Whether a bar stands on the line of stderr.

}  // namespace

void erase_progress_bar() {
  if (is_on_the_line.exchange(false)) std::fputs("\r\x1b[K", stderr);
}

ProgressBar::ProgressBar(std::size_t step_count)
    : step_count_(std::max<std::size_t>(step_count, 1)),
      is_shown_(isatty(STDERR_FILENO) == 1),
      next_draw_(Clock::now() + 300ms) {}

ProgressBar::~ProgressBar() { erase_progress_bar(); }

void ProgressBar::begin_step(std::size_t step, const std::string& what) {
  if (!is_shown_ || Clock::now() < next_draw_) return;
  next_draw_ = Clock::now() + 100ms;
  is_on_the_line = true;
  const std::size_t filled = std::min(kWidth, kWidth * step / step_count_);
  std::fprintf(stderr, "\r\x1b[K[%s%s] %zu/%zu %s", std::string(filled, '#').c_str(),
               std::string(kWidth - filled, '.').c_str(), step, step_count_, visible(what).c_str());
  std::fflush(stderr);
}

}  // namespace sunder::tools
