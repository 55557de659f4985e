#include "support/machine/watchdog.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <utility>

namespace sunder::test {
namespace {

double process_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

}  // namespace

Watchdog::Watchdog(double seconds, std::string what)
    : thread_([this, seconds, text = std::move(what)] {
        using Clock = std::chrono::steady_clock;
        const double used_before = process_seconds();
        // A call that waits uses no time of the processor; this ends it too.
        const auto latest = Clock::now() + std::chrono::duration<double>(20.0 * seconds);
        std::unique_lock lock(mutex_);
        while (
            !ended_.wait_for(lock, std::chrono::milliseconds(200), [this] { return has_ended_; })) {
          if (process_seconds() - used_before < seconds && Clock::now() < latest) continue;
          std::fprintf(stderr, "no end after %g s: %s\n", seconds, text.c_str());
          std::abort();
        }
      }) {}

Watchdog::~Watchdog() {
  {
    const std::scoped_lock lock(mutex_);
    has_ended_ = true;
  }
  ended_.notify_all();
  thread_.join();
}

}  // namespace sunder::test
