#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>

#include "io/internal/descriptor.h"

namespace sunder::import_messages {

using Clock = std::chrono::steady_clock;

enum class Transfer { complete, ended, timed_out };

/// One end of a stream socket. Calls wait until `deadline`, or for ever if there is none.
class Socket {
 public:
  explicit Socket(files::Descriptor descriptor,
                  std::optional<Clock::time_point> deadline = std::nullopt);

  /// Sends all bytes, and a copy of a descriptor with the first of them.
  Transfer send(std::span<const std::byte> bytes, int descriptor = -1);
  /// Receives exactly that many bytes. Descriptors that come with them are dropped by the kernel,
  /// unless the caller asks for one.
  Transfer receive(std::span<std::byte> bytes, files::Descriptor* descriptor = nullptr);

  template <class T>
  Transfer send_value(const T& value, int descriptor = -1) {
    return send(std::as_bytes(std::span(&value, 1)), descriptor);
  }
  template <class T>
  Transfer receive_value(T& value, files::Descriptor* descriptor = nullptr) {
    return receive(std::as_writable_bytes(std::span(&value, 1)), descriptor);
  }

  [[nodiscard]] int value() const { return descriptor_.value(); }

 private:
  [[nodiscard]] bool is_late() const;
  /// Waits for `events`. @return complete if a call may make progress.
  [[nodiscard]] Transfer wait(short events) const;

  files::Descriptor descriptor_;
  std::optional<Clock::time_point> deadline_;
};

/// Milliseconds until `deadline`, at least 0, for poll().
[[nodiscard]] int milliseconds_until(Clock::time_point deadline);

}  // namespace sunder::import_messages
