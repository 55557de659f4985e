#pragma once

#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// Tracks the border half-edges that cuts make through later splits and flips. Changes are logged,
/// so that they can be rolled back. The memory is kept from operation to operation.
class OpenedEdges {
 public:
  explicit OpenedEdges(const Surface& surface) : surface_(surface) {}

  /// Clears the set and the log. @param is_wanted  track half-edges from now on.
  void begin(bool is_wanted);
  /// The tracked half-edges that are still borders, ascending. Valid until the next call. Looks at
  /// those that the last call returned and at those tracked since, so that a stroke that asks after
  /// each of its blades does not look at all of its lips again; after roll_back() at all.
  [[nodiscard]] const std::vector<Index>& borders();
  /// Those of faces that are left, ascending.
  [[nodiscard]] std::vector<Index> tracked() const;

  /// Number of changes since begin(), for roll_back().
  [[nodiscard]] Index change_count() const { return static_cast<Index>(changes_.size()); }
  /// Reverts all changes after the first `change_count`. Does not allocate.
  void roll_back(Index change_count) noexcept;

  void add(Index a, Index b) {
    if (!is_wanted_) return;
    insert(a);
    insert(b);
  }
  /// Renames the half-edge `from`.
  void move(Index from, Index to) {
    if (remove(from)) insert(to);
  }
  /// Tracks `part`, which was split from `half_edge`, if `half_edge` is tracked.
  void split(Index half_edge, Index part) {
    if (is_wanted_ && contains(half_edge)) insert(part);
  }
  /// @return whether it was tracked.
  bool remove(Index half_edge);

 private:
  struct Change {
    Index half_edge;
    bool is_insertion;
  };

  [[nodiscard]] std::size_t place_of(Index half_edge) const;
  /// The slot of a half-edge, or the free one where it would be.
  [[nodiscard]] std::size_t slot_of(Index half_edge) const;
  [[nodiscard]] bool contains(Index half_edge) const {
    return count_ > 0 && slots_[slot_of(half_edge)] == half_edge;
  }
  void insert(Index half_edge);
  void grow();
  void free_slot(std::size_t slot) noexcept;

  const Surface& surface_;
  /// A table with open addressing, at least half of it free; no result depends on its order.
  std::vector<Index> slots_;
  std::size_t count_ = 0;
  std::vector<Change> changes_;
  /// Holds at least all borders, in any order and with repetitions, unless `is_rolled_back_`.
  std::vector<Index> borders_;
  bool is_rolled_back_ = false;
  bool is_wanted_ = false;
};

}  // namespace sunder::tear
