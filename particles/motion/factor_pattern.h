#pragma once

#include <span>

#include "particles/motion/elimination_order.h"
#include "particles/motion/spring_matrix.h"

namespace sunder::particles {

/// Where the factor L of a spring matrix has entries. The nodes of a group are eliminated together.
/// Their columns of L are a dense panel: one row per node of the group, per later row that they are
/// coupled to (the border), and for the ground. Pulls are eliminated last, as a group.
class FactorPattern {
 public:
  /// Nodes that are eliminated together, or the pulls.
  struct Group {
    Index begin = 0, end = 0;                ///< Places in the order.
    Index first_border = 0, border_end = 0;  ///< In borders().
    Index first_target = 0, target_end = 0;  ///< In targets().
    std::size_t panel = 0;                   ///< Its place in the panels, column by column.
    Index pulls = 0;                         ///< Number of them in its border, at the end.
    [[nodiscard]] Index pivots() const { return end - begin; }
    [[nodiscard]] Index border() const { return border_end - first_border; }
    [[nodiscard]] Index height() const { return pivots() + border() + 1; }
  };
  /// A later group that owns consecutive rows of a group's border.
  struct Target {
    Index group = 0;
    Index first = 0, end = 0;  ///< Within the border.
    Index rows = 0;  ///< In target_rows(): its panel's rows of the border from `first` on.
  };

  /// Finds an order of elimination, and all below. O(entries of the factor); no allocation once
  /// warm. @throws std::bad_alloc
  void analyse(const SpringMatrix::Pattern& matrix);

  /// The nodes, in the order of elimination. Pulls follow; the place of a pull is its row.
  [[nodiscard]] std::span<const Index> nodes() const { return order_.nodes(); }
  [[nodiscard]] std::span<const Group> groups() const { return groups_; }
  /// Places, ascending for each group.
  [[nodiscard]] std::span<const Index> borders() const { return borders_; }
  [[nodiscard]] std::span<const Target> targets() const { return targets_; }
  [[nodiscard]] std::span<const Index> target_rows() const { return target_rows_; }
  /// Per entry of the matrix its place in the panels.
  [[nodiscard]] std::span<const std::size_t> slots() const { return slots_; }
  /// Entries of all panels; number of nodes and pulls; rows of the tallest panel.
  [[nodiscard]] std::size_t panel_entries() const;
  [[nodiscard]] std::size_t rows() const { return group_of_.size(); }
  [[nodiscard]] std::size_t tallest() const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  void find_springs(const SpringMatrix::Pattern& matrix);
  void find_groups(const SpringMatrix::Pattern& matrix);
  void find_border(const SpringMatrix::Pattern& matrix, Index group);
  void find_targets(Group& group);
  void find_slots(const SpringMatrix::Pattern& matrix);

  EliminationOrder order_;
  // Per node its springs, from both ends: the other node, and the entry.
  std::vector<Index> first_, others_, entries_;
  std::vector<Group> groups_;
  std::vector<Index> group_of_;  // per place
  std::vector<Index> borders_;
  std::vector<Target> targets_;
  std::vector<Index> target_rows_;
  std::vector<std::size_t> slots_;
  std::vector<std::uint64_t> in_border_;  // a bit per place; 0 between calls
  std::vector<Index> rows_;               // of a panel, per place
  std::vector<Index> children_, siblings_;
};

}  // namespace sunder::particles
