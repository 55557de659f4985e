#pragma once

#include <sunder/tear/torn_asset.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

namespace sunder::tools {

/// The work that a verb may do on what strangers give it.
struct BudgetLimits {
  double seconds = 300;              ///< For each piece of work: Budget::allow_each().
  double megabytes = 4096;           ///< 2^20 bytes each, of the whole process.
  std::uint32_t vertices = 1000000;  ///< That operations may add to a mesh.
};

/// Ends the command with a message and exit code 4 when its work takes more time or memory than
/// allowed, wherever that work is: a thread watches it. It never ends while files are written.
class Budget {
 public:
  /// @param place  what the work is on, for the message: "fox.glb".
  Budget(const BudgetLimits& limits, std::string place);
  ~Budget();
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;

  /// Says what the work is on from now: "ops.json: /operations/3".
  void begin(const std::string& place);
  /// Allows the time of the limits for each of several pieces of work together; at first for one.
  void allow_each(std::size_t pieces);
  /// The work is done; results follow, which are not limited.
  void end();

  /// While one exists, files are written, and the command is not ended.
  class Writing {
   public:
    explicit Writing(Budget& budget);
    ~Writing();
    Writing(const Writing&) = delete;
    Writing& operator=(const Writing&) = delete;

   private:
    Budget& budget_;
  };

  /// The room for operations on a model; four times as many triangles as vertices.
  [[nodiscard]] TornCapacity capacity() const;

 private:
  using Clock = std::chrono::steady_clock;

  void watch();
  /// Ends the command if a limit is exceeded. The mutex is locked.
  void check() const;
  /// @param format  of the limit, a number; @param option  that sets it.
  [[noreturn]] void stop(const char* format, double limit, const char* option) const;

  const BudgetLimits limits_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string place_;
  double seconds_;  ///< For all pieces of work.
  bool has_ended_ = false;
  int writing_ = 0;
  std::thread watch_;
};

}  // namespace sunder::tools
