#pragma once

#include <sunder/validation/certificate.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "validation/checks/pose_batches.h"

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
    PosedPoint sum = {PoseArray::Zero(), PoseArray::Zero(), PoseArray::Zero()};
    for (const SkinTerm& term : terms) {
      const PoseArray* const m = entries_.data() + 12 * std::size_t{term.bone};
      const double x = term.x[0], y = term.x[1], z = term.x[2];
      sum.x += m[0] * x + m[1] * y + m[2] * z + m[3] * term.m;
      sum.y += m[4] * x + m[5] * y + m[6] * z + m[7] * term.m;
      sum.z += m[8] * x + m[9] * y + m[10] * z + m[11] * term.m;
    }
    return sum;
  }
  /// The blended linear part of a skinned point in all poses, by row.
  [[nodiscard]] std::array<PosedPoint, 3> blend(std::span<const SkinTerm> terms) const;

 private:
  std::size_t first_, count_;
  std::vector<PoseArray> entries_;  // 12 per bone, by row
};

/// Calls visit(block) for all blocks of the first `most` poses of a batch, one after the other.
template <class Visit>
void for_each_block(const PoseBatch& batch, std::size_t most, const Visit& visit) {
  const std::size_t end = std::min(batch.poses.size(), most);
  for (std::size_t first = 0; first < end; first += kPosesPerBlock)
    visit(PoseBlock(batch, first, end));
}

}  // namespace sunder::validation
