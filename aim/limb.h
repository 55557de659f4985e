#pragma once

#include <sunder/operation/aimed_operation.h>

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
  std::string label;            ///< For error texts: "'LeftArm' at 0.40".
};

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
