#pragma once

#include <sunder/core/math.h>

#include <cstdint>
#include <vector>

namespace sunder {

/// One term of a difference of two skinned points of one skeleton: model_from_bind(bone) * (x, m).
struct SkinTerm {
  std::uint32_t bone = 0;   ///< In the skeleton.
  double m = 0.0;           ///< Net weight.
  Vec3d x = Vec3d::Zero();  ///< Weighted bind position, model space of the bind pose, metres.
};

/// Differences of skinned points, back to back. A point that is equal in both skins has no term.
struct SkinDifferences {
  std::vector<std::uint32_t> first = {0};  ///< One per point and one more: offsets into `terms`.
  std::vector<SkinTerm> terms;             ///< Each bone at most once per point, ascending.
};

}  // namespace sunder
