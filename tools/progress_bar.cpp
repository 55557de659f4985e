#include "tools/progress_bar.h"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace sunder::tools {
namespace {

using namespace std::chrono_literals;
constexpr std::size_t kWidth = 30;

}  // namespace

ProgressBar::ProgressBar(std::size_t step_count)
    : step_count_(std::max<std::size_t>(step_count, 1)),
      is_shown_(isatty(STDERR_FILENO) == 1),
      next_draw_(Clock::now() + 300ms) {}

ProgressBar::~ProgressBar() {
  if (has_drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::begin_step(std::size_t step, const std::string& what) {
  if (!is_shown_ || Clock::now() < next_draw_) return;
  next_draw_ = Clock::now() + 100ms;
  has_drawn_ = true;
  const std::size_t filled = std::min(kWidth, kWidth * step / step_count_);
  std::fprintf(stderr, "\r\x1b[K[%s%s] %zu/%zu %s", std::string(filled, '#').c_str(),
               std::string(kWidth - filled, '.').c_str(), step, step_count_, what.c_str());
  std::fflush(stderr);
}

}  // namespace sunder::tools
