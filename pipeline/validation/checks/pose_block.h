#pragma once

#include <sunder/certificate/certificate.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "pipeline/validation/checks/pose_batches.h"

namespace sunder::validation {

/// One number per pose of a block.
inline constexpr std::size_t kPosesPerBlock = 8;
using PoseArray = Eigen::Array<double, static_cast<int>(kPosesPerBlock), 1>;

/// A point, or a vector, in each pose of a block.
struct PosedPoint {
  PoseArray x, y, z;

  [[nodiscard]] PoseArray squared_length() const { return x * x + y * y + z * z; }
  [[nodiscard]] PoseArray length() const { return squared_length().sqrt(); }

  // Friends, so that they do not hide the functions of these names for single points.
  friend PosedPoint operator-(const PosedPoint& a, const PosedPoint& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend PosedPoint cross(const PosedPoint& a, const PosedPoint& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  friend PoseArray dot(const PosedPoint& a, const PosedPoint& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
};

/// Some poses of a batch side by side, so that a row is read once and posed in all of them by
/// vector instructions. Sums have the order of a single pose: the same bits.
class PoseBlock {
 public:
  /// @param first  of the batch's poses; the block has at most those before `end`. Lanes after the
  ///               last pose pose everything to the origin.
  PoseBlock(const PoseBatch& batch, std::size_t first, std::size_t end);

  [[nodiscard]] std::size_t first() const { return first_; }
  /// Number of poses.
  [[nodiscard]] std::size_t count() const { return count_; }

  /// A skinned point in all poses.
  [[nodiscard]] PosedPoint pose(std::span<const SkinTerm> terms) const {
    // Plain loops, each over its own sums: compilers keep these in registers.
    PosedPoint point;
    for (const auto& [sum, row] : {std::pair(&point.x, 0u), {&point.y, 4u}, {&point.z, 8u}}) {
      double sums[kPosesPerBlock] = {};
      for (const SkinTerm& term : terms) {
        const double* const m = entry(term.bone, row);
        const double x = term.x[0], y = term.x[1], z = term.x[2], w = term.m;
        for (std::size_t i = 0; i < kPosesPerBlock; ++i)
          sums[i] += m[i] * x + m[i + kPosesPerBlock] * y + m[i + 2 * kPosesPerBlock] * z +
                     m[i + 3 * kPosesPerBlock] * w;
      }
      for (std::size_t i = 0; i < kPosesPerBlock; ++i)
        (*sum)[static_cast<Eigen::Index>(i)] = sums[i];
    }
    return point;
  }
  /// The blended linear part of a skinned point in all poses, by row.
  [[nodiscard]] std::array<PosedPoint, 3> blend(std::span<const SkinTerm> terms) const;

 private:
  /// An entry of a bone's 3 x 4 matrix, counted row by row, in all poses.
  [[nodiscard]] const double* entry(Index bone, std::size_t index) const {
    return entries_.data() + kPosesPerBlock * (12 * std::size_t{bone} + index);
  }

  std::size_t first_, count_;
  std::vector<double> entries_;
};

/// Calls visit(block) for all blocks of the first `most` poses of a batch, one after the other.
template <class Visit>
void for_each_block(const PoseBatch& batch, std::size_t most, const Visit& visit) {
  const std::size_t end = std::min(batch.poses.size(), most);
  for (std::size_t first = 0; first < end; first += kPosesPerBlock)
    visit(PoseBlock(batch, first, end));
}

}  // namespace sunder::validation
