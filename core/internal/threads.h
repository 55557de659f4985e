#pragma once

// Locks and threads, and what takes their place on a platform without threads (WebAssembly), where
// every lock is free and no thread can be started.

#include <mutex>

#if defined(__wasm__) && !defined(_REENTRANT)
#include <cstdlib>

namespace sunder {

inline constexpr bool kHasThreads = false;

struct Mutex {
  void lock() {}
  bool try_lock() { return true; }
  void unlock() {}
};

struct Condition {
  void notify_one() {}
  void notify_all() {}
  /// There is nobody who could make it true.
  template <class Lock, class Predicate>
  void wait(Lock& /*lock*/, Predicate is_true) {
    if (!is_true()) std::abort();
  }
};

struct Thread {
  Thread() = default;
  template <class Work>
  explicit Thread(Work /*work*/) {
    std::abort();
  }
  [[nodiscard]] bool joinable() const { return false; }
  void join() {}
  static unsigned hardware_concurrency() { return 1; }
};

}  // namespace sunder

#else
#include <condition_variable>
#include <thread>

namespace sunder {

inline constexpr bool kHasThreads = true;

using Mutex = std::mutex;
using Condition = std::condition_variable;
using Thread = std::thread;

}  // namespace sunder

#endif
