#pragma once

#include <unistd.h>
#include <utility>

namespace sunder::files {

/// An open file descriptor, closed at the end of the scope. -1: none.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    if (this != &other) {
      reset();
      value_ = std::exchange(other.value_, -1);
    }
    return *this;
  }
  ~Descriptor() { reset(); }

  void reset() {
    if (value_ >= 0) close(value_);
    value_ = -1;
  }
  /// @return false, with errno, if the system reports only now that a write has failed.
  [[nodiscard]] bool close_now() { return close(std::exchange(value_, -1)) == 0; }
  [[nodiscard]] int value() const { return value_; }
  [[nodiscard]] bool is_open() const { return value_ >= 0; }

 private:
  int value_ = -1;
};

}  // namespace sunder::files
