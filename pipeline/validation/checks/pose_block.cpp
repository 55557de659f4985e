#include "pipeline/validation/checks/pose_block.h"

#include <algorithm>

namespace sunder::validation {

PoseBlock::PoseBlock(const PoseBatch& batch, std::size_t first, std::size_t end)
    : first_(first), count_(std::min(kPosesPerBlock, end - first)) {
  const std::size_t bones = batch.poses[first].size();
  entries_.assign(kPosesPerBlock * 12 * bones, 0.0);
  for (std::size_t lane = 0; lane < count_; ++lane)
    for (std::size_t bone = 0; bone < bones; ++bone) {
      const auto& matrix = batch.poses[first + lane][bone].matrix();
      for (std::size_t i = 0; i < 12; ++i)
        entries_[kPosesPerBlock * (12 * bone + i) + lane] =
            matrix(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4));
    }
}

std::array<PosedPoint, 3> PoseBlock::blend(std::span<const SkinTerm> terms) const {
  const PosedPoint zero = {PoseArray::Zero(), PoseArray::Zero(), PoseArray::Zero()};
  std::array<PosedPoint, 3> rows = {zero, zero, zero};
  for (const SkinTerm& term : terms)
    for (std::size_t row = 0; row < 3; ++row) {
      using Entry = Eigen::Map<const PoseArray>;
      rows[row].x += term.m * Entry(entry(term.bone, 4 * row));
      rows[row].y += term.m * Entry(entry(term.bone, 4 * row + 1));
      rows[row].z += term.m * Entry(entry(term.bone, 4 * row + 2));
    }
  return rows;
}

}  // namespace sunder::validation
