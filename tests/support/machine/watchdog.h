#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace sunder::test {

/// Ends the program with a message if it computes for longer than this during the object's
/// lifetime, or waits for twenty times as long: a guard against calls that never return, not a
/// measurement. It counts the time of the processor, so a busy machine does not trigger it.
class Watchdog {
 public:
  Watchdog(double seconds, std::string what);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool has_ended_ = false;
  std::thread thread_;
};

}  // namespace sunder::test
