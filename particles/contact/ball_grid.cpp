#include "particles/contact/ball_grid.h"

#include <cmath>

namespace sunder::particles {
namespace {

/// Cells are larger than the reach by this factor, so that rounding loses no ball.
constexpr double kCellReaches = 1.001;
constexpr double kMostCellsPerBall = 2, kFewCells = 27;

}  // namespace

Index BallGrid::cell_of(const Vec3d& at) const {
  std::array<Index, 3> cell;
  for (int axis = 0; axis < 3; ++axis)
    cell[axis] = std::min(static_cast<Index>((at[axis] - low_[axis]) / size_), counts_[axis] - 1);
  return (cell[2] * counts_[1] + cell[1]) * counts_[0] + cell[0];
}

void BallGrid::fill(const std::vector<Ball>& balls, double reach) {
  counts_ = {0, 0, 0};
  if (balls.empty()) return;
  low_ = balls[0].at;
  Vec3d high = low_;
  for (const Ball& ball : balls) {
    low_ = low_.cwiseMin(ball.at);
    high = high.cwiseMax(ball.at);
  }
  const auto cells_along = [&](int axis) {
    return std::floor((high[axis] - low_[axis]) / size_) + 1;
  };
  const double most = kFewCells + kMostCellsPerBall * static_cast<double>(balls.size());
  size_ = kCellReaches * reach;
  while (cells_along(0) * cells_along(1) * cells_along(2) > most) size_ *= 2;
  for (int axis = 0; axis < 3; ++axis) counts_[axis] = static_cast<Index>(cells_along(axis));
  // Counting sort: starts_ moves from the ends of the cells to their starts.
  starts_.assign(std::size_t{counts_[0]} * counts_[1] * counts_[2] + 1, 0);
  sorted_.resize(balls.size());
  for (const Ball& ball : balls) ++starts_[cell_of(ball.at)];
  Index end = 0;
  for (Index& start : starts_) start = end += start;
  for (std::size_t i = balls.size(); i-- > 0;) sorted_[--starts_[cell_of(balls[i].at)]] = balls[i];
}

}  // namespace sunder::particles
