#include "tools/budget/budget.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <new>
#include <unistd.h>
#include <utility>

#include "tools/messages/exit_code.h"
#include "tools/messages/messages.h"

namespace sunder::tools {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks(50);
constexpr double kMegabyte = 1 << 20;

/// The memory of the process that is in use now; 0 where the system does not say.
double resident_megabytes() {
  std::ifstream file("/proc/self/statm");
  unsigned long long all = 0, resident = 0;
  file >> all >> resident;
  return file ? static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) /
                    kMegabyte
              : 0;
}

}  // namespace

Budget::Budget(const BudgetLimits& limits, std::string place)
    : limits_(limits),
      place_(std::move(place)),
      seconds_(limits.seconds),
      watch_([this] { watch(); }) {}

Budget::~Budget() {
  {
    const std::scoped_lock lock(mutex_);
    has_ended_ = true;
  }
  changed_.notify_one();
  watch_.join();
}

void Budget::begin(const std::string& place) {
  const std::scoped_lock lock(mutex_);
  place_ = place;
}

void Budget::allow_each(std::size_t pieces) {
  const std::scoped_lock lock(mutex_);
  seconds_ = limits_.seconds * static_cast<double>(std::max<std::size_t>(pieces, 1));
}

void Budget::end() {
  const std::scoped_lock lock(mutex_);
  if (has_ended_) return;
  check();
  has_ended_ = true;
  changed_.notify_one();
}

Budget::Writing::Writing(Budget& budget) : budget_(budget) {
  const std::scoped_lock lock(budget_.mutex_);
  if (!budget_.has_ended_ && budget_.writing_ == 0) budget_.check();
  ++budget_.writing_;
}

Budget::Writing::~Writing() {
  const std::scoped_lock lock(budget_.mutex_);
  --budget_.writing_;
}

TornCapacity Budget::capacity() const {
  constexpr std::uint32_t kPerVertex = 4;
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max() / kPerVertex;
  return {limits_.vertices, kPerVertex * std::min(limits_.vertices, kMost), kNone};
}

void Budget::watch() {
  std::unique_lock lock(mutex_);
  while (!has_ended_) {
    if (writing_ == 0) check();
    changed_.wait_for(lock, kBetweenLooks, [this] { return has_ended_; });
  }
}

void Budget::check() const {
  if (std::chrono::duration<double>(Clock::now() - start_).count() > seconds_)
    stop("%g s", seconds_, "--max-seconds");
  if (resident_megabytes() > limits_.megabytes)
    stop("%g MB of memory", limits_.megabytes, "--max-memory");
}

/// Nothing is left half written: files are written beside their places, and no thread of the
/// command is at that.
void Budget::stop(const char* format, double limit, const char* option) const {
  char amount[64];
  (void)std::snprintf(amount, sizeof amount, format, limit);
  try {
    print_error("sunder: " + place_ + ": takes more than " + amount + "; " + option +
                " allows more (" + std::string(status_name(StatusCode::limit_exceeded)) + ")");
  } catch (const std::bad_alloc&) {
    // The exit code says it.
  }
  std::fflush(nullptr);  // what is finished
  std::_Exit(static_cast<int>(ExitCode::limit_exceeded));
}

}  // namespace sunder::tools
