#pragma once

#include <sunder/operation/aimed_operation.h>

#include <optional>
#include <string>

#include "core/internal/number_range.h"
#include "pipeline/aim/bone_segment.h"
#include "pipeline/aim/limb_bones.h"

namespace sunder::aim {

/// A place on a limb, in the pose of the operation.
struct Limb {
  const PosedSurface& surface;
  LimbBones bones;
  BoneSegment segment;
  double at = 0;
  Vec3d place = Vec3d::Zero();  ///< On the bone's line.
  std::string label = {};       ///< For error texts: "'LeftArm' at 0.40".
};

/// Whether a place is in the first quarter of its bone, where the limb shares its surface with the
/// parent.
[[nodiscard]] inline bool is_near_joint(const Limb& limb) { return limb.at < 0.25; }

/// The same limb at another share.
[[nodiscard]] Limb limb_at(const Limb& limb, double at);

/// The nearest of 20 shares of a bone that a predicate accepts, the given one left out, those
/// towards its end first; empty if there is none.
template <class Predicate>
[[nodiscard]] std::optional<double> nearest_share(double at, Predicate accepts) {
  constexpr int kSteps = 20;
  for (int step = 1; step <= kSteps; ++step)
    for (const int direction : {1, -1}) {
      const double share = at + direction * step / static_cast<double>(kSteps);
      if (share >= 0 && share <= 1 && accepts(share)) return share;
    }
  return {};
}

/// @return the failures of find_bone() and bone_segment(); invalid_argument for a share beyond 0
///         and 1.
[[nodiscard]] Result<Limb> find_limb(const PosedSurface& surface, const LimbPlace& place);

/// Checks lengths that no limb of that size can hold; they are mostly meant in another unit.
/// @param most  the size of the limb, metres. @param size  what it is: "the limb is wide there".
/// @return invalid_argument.
[[nodiscard]] Status check_within_limb(const Limb& limb, const char* field, double value,
                                       double most, const char* size);
[[nodiscard]] inline double metres(const AimedLength& length, double width) {
  return length.unit == AimedLength::Unit::widths ? length.value * width : length.value;
}

}  // namespace sunder::aim
