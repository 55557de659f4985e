#pragma once

#include <unordered_set>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// Tracks the border half-edges that cuts make through later splits and flips. Changes are logged,
/// so that they can be rolled back.
class OpenedEdges {
 public:
  explicit OpenedEdges(const Surface& surface) : surface_(surface) {}

  /// Clears the set and the log. @param is_wanted  track half-edges from now on.
  void begin(bool is_wanted) {
    is_wanted_ = is_wanted;
    half_edges_.clear();
    changes_.clear();
  }
  /// The tracked half-edges that are still borders, ascending.
  [[nodiscard]] std::vector<Index> borders() const;
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
    if (is_wanted_ && half_edges_.count(half_edge) != 0) insert(part);
  }
  /// @return whether it was tracked.
  bool remove(Index half_edge) { return is_wanted_ && extract(half_edge); }

 private:
  using HalfEdges = std::unordered_set<Index>;
  struct Change {
    Index inserted = kNone;
    HalfEdges::node_type extracted;  ///< Kept, so that it can be put back without memory.
  };

  void insert(Index half_edge);
  bool extract(Index half_edge);

  const Surface& surface_;
  HalfEdges half_edges_;  // no result depends on its order
  std::vector<Change> changes_;
  bool is_wanted_ = false;
};

}  // namespace sunder::tear
