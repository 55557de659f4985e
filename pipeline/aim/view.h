#pragma once

#include <optional>

#include "pipeline/aim/limb.h"

namespace sunder::aim {

/// The axes in which a limb is seen. Right-handed, unit length: across x towards_viewer = along.
struct ViewFrame {
  Vec3d across = Vec3d(1.0, 0.0, 0.0);  ///< Across the limb.
  Vec3d towards_viewer = Vec3d(0.0, 0.0, 1.0);
  Vec3d along = Vec3d(0.0, -1.0, 0.0);  ///< Of the bone.

  /// The direction across the limb, turned counter-clockwise as seen.
  [[nodiscard]] Vec3d turned(double radians) const;
};

/// @param from  empty: from the front, or from the left if the bone points to the front or the
/// back.
/// @return invalid_argument for a direction that is not finite, has no length, or is within 15
///         degrees of the bone.
[[nodiscard]] Result<ViewFrame> view_frame(const Limb& limb, const std::optional<View>& from);

}  // namespace sunder::aim
