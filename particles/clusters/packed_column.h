#pragma once

#include <sunder/core/index.h>

#include <cstring>
#include <span>
#include <vector>

#include "particles/clusters/point_table.h"
#include "particles/internal/vector_bytes.h"

namespace sunder::particles {

/// The entries of a column that differ from those of another one, and those behind its end.
template <class T>
class PackedColumn {
 public:
  PackedColumn() = default;
  /// @param column  at least as long as `shared`.
  PackedColumn(std::span<const T> column, std::span<const T> shared)
      : appended_(column.begin() + static_cast<std::ptrdiff_t>(shared.size()), column.end()) {
    for (Index i = 0; i < shared.size(); ++i)
      if (!has_same_bytes(column[i], shared[i])) {
        places_.push_back(i);
        changed_.push_back(column[i]);
      }
    places_.shrink_to_fit();
    changed_.shrink_to_fit();
  }
  void unpack(std::span<const T> shared, std::vector<T>& column) const {
    column.clear();
    reserve_eighth(column, shared.size() + appended_.size() + 1);
    column.assign(shared.begin(), shared.end());
    for (std::size_t i = 0; i < places_.size(); ++i) column[places_[i]] = changed_[i];
    column.insert(column.end(), appended_.begin(), appended_.end());
  }
  [[nodiscard]] std::size_t memory_bytes() const {
    return bytes_of(places_) + bytes_of(changed_) + bytes_of(appended_);
  }

 private:
  /// Bytes between members may differ without need.
  [[nodiscard]] static bool has_same_bytes(const T& a, const T& b) {
    return std::memcmp(static_cast<const void*>(&a), static_cast<const void*>(&b), sizeof(T)) == 0;
  }

  std::vector<Index> places_;
  std::vector<T> changed_, appended_;
};

}  // namespace sunder::particles
