#pragma once

#include <sunder/operation/aimed_operation.h>

#include <optional>
#include <string>

#include "aim/bone_segment.h"
#include "aim/limb_bones.h"

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

/// @param what  for the error text.
/// @return invalid_argument unless the length is finite and > 0.
[[nodiscard]] Status check_length(const AimedLength& length, const char* what);
[[nodiscard]] inline double metres(const AimedLength& length, double width) {
  return length.unit == AimedLength::Unit::widths ? length.value * width : length.value;
}

}  // namespace sunder::aim
