#pragma once

#include <sunder/core/index.h>

#include <utility>

#include "tear/internal/surface.h"

namespace sunder::particles {

/// A set of marked indices. Clearing it costs nothing.
class Marks {
 public:
  void begin(std::size_t count) {
    grow(count);
    if (++epoch_ == 0) {  // once in 2^32 uses
      std::fill(stamps_.begin(), stamps_.end(), 0);
      epoch_ = 1;
    }
  }
  /// Makes room for more indices.
  void grow(std::size_t count) {
    if (stamps_.size() < count) stamps_.resize(count + count / 8 + 16, 0);
  }
  [[nodiscard]] bool has(Index i) const { return stamps_[i] == epoch_; }
  [[nodiscard]] std::size_t memory_bytes() const { return stamps_.capacity() * sizeof(stamps_[0]); }
  /// @return whether the index was not marked yet.
  bool mark(Index i) { return std::exchange(stamps_[i], epoch_) != epoch_; }

 private:
  std::vector<std::uint32_t> stamps_;
  std::uint32_t epoch_ = 1;
};

}  // namespace sunder::particles
