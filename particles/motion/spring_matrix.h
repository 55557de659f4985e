#pragma once

#include <sunder/core/index.h>

#include <vector>

namespace sunder::particles {

/// The equations of springs between nodes, of springs from nodes to the ground, and of pulls, which
/// are springs to weighted sums of nodes. Rows are those of the nodes, then those of the pulls,
/// whose unknowns are their forces g. With the matrix A of the springs, whose diagonal is the sum
/// of all stiffnesses at a node, the weights W and the compliances C of the pulls:
///
///   A x - W g = right-hand side of the nodes
///   -W^T x - C g = right-hand side of the pulls
struct SpringMatrix {
  /// Where entries are.
  struct Pattern {
    std::vector<Index> first = {0};  ///< Per node its first entry; the total at the end.
    /// Per entry of a node the row of a later node, of a spring, or of a pull. Entries of the same
    /// place add up.
    std::vector<Index> columns;
    Index pulls = 0;  ///< Number of them.

    [[nodiscard]] Index nodes() const { return static_cast<Index>(first.size() - 1); }

    bool operator==(const Pattern&) const = default;
  };

  Pattern pattern;
  std::vector<double> values;       ///< Per entry the stiffness or the weight; >= 0.
  std::vector<double> grounds;      ///< Per node the stiffness to the ground; > 0.
  std::vector<double> compliances;  ///< Per pull; > 0.

  bool operator==(const SpringMatrix&) const = default;
};

}  // namespace sunder::particles
