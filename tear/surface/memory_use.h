#pragma once

#include <sunder/core/character.h>

#include <cstddef>
#include <vector>

#include "tear/surface/edit_columns.h"

namespace sunder::tear {

/// Sums the memory of arrays, bytes.
class MemoryUse {
 public:
  [[nodiscard]] std::size_t used() const { return used_; }
  /// With what is reserved.
  [[nodiscard]] std::size_t held() const { return held_; }

  void add(std::size_t used, std::size_t held) {
    used_ += used;
    held_ += held;
  }
  void add(const MemoryUse& other) { add(other.used_, other.held_); }
  template <class T>
  void add(const std::vector<T>& values) {
    add(values.size() * sizeof(T), values.capacity() * sizeof(T));
  }
  void add(const std::vector<bool>& values) { add(values.size() / 8, values.capacity() / 8); }
  void add(const Mesh& mesh);
  void add(const Character& character);
  void add(const Surface& surface);
  void add(const EditColumns& columns);

 private:
  std::size_t used_ = 0, held_ = 0;
};

}  // namespace sunder::tear
