#pragma once

#include <unordered_set>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// Follows the border half-edges that cuts make, wherever later splits and flips take them.
class OpenedEdges {
 public:
  explicit OpenedEdges(const Surface& surface) : surface_(surface) {}

  /// Forgets all. @param is_wanted  nothing is followed otherwise.
  void begin(bool is_wanted) {
    is_wanted_ = is_wanted;
    half_edges_.clear();
  }
  /// Those that are still borders, ascending.
  [[nodiscard]] std::vector<Index> borders() const;

  /// All that is followed, so that a call that fails can put it back.
  [[nodiscard]] const std::unordered_set<Index>& half_edges() const { return half_edges_; }
  void restore(std::unordered_set<Index>& before) { half_edges_.swap(before); }

  void add(Index a, Index b) {
    if (is_wanted_) half_edges_.insert({a, b});
  }
  /// The half-edge `from` was renamed.
  void move(Index from, Index to) {
    if (remove(from)) half_edges_.insert(to);
  }
  /// `half_edge` was split: its part is followed where the half-edge is.
  void split(Index half_edge, Index part) {
    if (is_wanted_ && half_edges_.count(half_edge) != 0) half_edges_.insert(part);
  }
  /// @return whether it was followed.
  bool remove(Index half_edge) { return is_wanted_ && half_edges_.erase(half_edge) > 0; }

 private:
  const Surface& surface_;
  std::unordered_set<Index> half_edges_;  // its order decides nothing
  bool is_wanted_ = false;
};

}  // namespace sunder::tear
