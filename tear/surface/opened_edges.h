#pragma once

#include <unordered_set>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// Tracks the border half-edges that cuts make through later splits and flips.
class OpenedEdges {
 public:
  explicit OpenedEdges(const Surface& surface) : surface_(surface) {}

  /// Clears the set. @param is_wanted  track half-edges from now on.
  void begin(bool is_wanted) {
    is_wanted_ = is_wanted;
    half_edges_.clear();
  }
  /// The tracked half-edges that are still borders, ascending.
  [[nodiscard]] std::vector<Index> borders() const;

  /// All tracked half-edges, so that a failed call can restore them.
  [[nodiscard]] const std::unordered_set<Index>& half_edges() const { return half_edges_; }
  void restore(std::unordered_set<Index>& before) { half_edges_.swap(before); }

  void add(Index a, Index b) {
    if (is_wanted_) half_edges_.insert({a, b});
  }
  /// Renames the half-edge `from`.
  void move(Index from, Index to) {
    if (remove(from)) half_edges_.insert(to);
  }
  /// Tracks `part`, which was split from `half_edge`, if `half_edge` is tracked.
  void split(Index half_edge, Index part) {
    if (is_wanted_ && half_edges_.count(half_edge) != 0) half_edges_.insert(part);
  }
  /// @return whether it was tracked.
  bool remove(Index half_edge) { return is_wanted_ && half_edges_.erase(half_edge) > 0; }

 private:
  const Surface& surface_;
  std::unordered_set<Index> half_edges_;  // no result depends on its order
  bool is_wanted_ = false;
};

}  // namespace sunder::tear
