#pragma once

#include <sunder/core/math.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sunder::particles {

/// Where a particle is, and how far from there its contact points may be.
struct Ball {
  Vec3d at = Vec3d::Zero();
  double reach = 0;
  double moved_square = 0;  ///< Square of its displacement.
  Index particle = 0;
};

/// Finds balls by their places: a grid of cells over the box around all.
class BallGrid {
 public:
  /// Sorts balls into cells. O(balls). @throws std::bad_alloc
  /// @param reach  the greatest distance at which later calls must find balls; above 0.
  void fill(const std::vector<Ball>& balls, double reach);
  /// Calls visit(ball) for all balls within the reach of a place, and for some beyond.
  template <class Visit>
  void for_each_near(const Vec3d& at, Visit visit) const {
    std::array<Index, 3> first, last;
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = std::floor((at[axis] - low_[axis]) / size_);
      if (cell < -1 || cell > counts_[axis]) return;
      first[axis] = static_cast<Index>(std::max(cell - 1, 0.0));
      last[axis] = static_cast<Index>(std::min(cell + 1, counts_[axis] - 1.0));
    }
    for (Index z = first[2]; z <= last[2]; ++z)
      for (Index y = first[1]; y <= last[1]; ++y) {
        const Index row = (z * counts_[1] + y) * counts_[0];
        for (Index i = starts_[row + first[0]]; i < starts_[row + last[0] + 1]; ++i)
          visit(sorted_[i]);
      }
  }
  [[nodiscard]] std::size_t memory_bytes() const {
    return starts_.capacity() * sizeof(Index) + sorted_.capacity() * sizeof(Ball);
  }

 private:
  [[nodiscard]] Index cell_of(const Vec3d& at) const;

  Vec3d low_ = Vec3d::Zero();
  double size_ = 1;                          ///< Edge of a cell.
  std::array<Index, 3> counts_ = {0, 0, 0};  ///< Cells along each axis.
  std::vector<Index> starts_;                ///< Per cell, of its balls in `sorted_`; and the end.
  std::vector<Ball> sorted_;
};

}  // namespace sunder::particles
