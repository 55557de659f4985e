#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>
#include <sunder/core/status.h>

namespace sunder {

/// How tissue resists a blade.
struct CuttingResistance {
  double toughness = 0.0;  ///< Energy per area of new section, J/m^2; >= 0.
  double thickness = 0.0;  ///< Of the layer that is torn, metres; >= 0.
  /// Drag on the blade inside the tissue, newtons per metre of depth; >= 0.
  double friction = 0.0;
  /// Greatest force, newtons; > 0: that of the device.
  double greatest = 1e6;
};

/// The motion of a blade since the last frame.
struct BladeStep {
  double length_torn = 0.0;      ///< TearReport::length_posed of the frame, metres; >= 0.
  double depth = 0.0;            ///< Of the tip below the surface, metres; <= 0: outside.
  Vec3d motion = Vec3d::Zero();  ///< Of the blade's tip, model space, metres.
};

struct BladeForce {
  double newtons = 0.0;
  Vec3d direction = Vec3d::Zero();  ///< Opposes the motion; unit length, or zero without motion.
};

/// The force that a blade feels, from the balance of energy: its work along the motion is the
/// toughness times the area of the section it made,
///   F |motion| = toughness * length_torn * min(depth, thickness),
/// plus friction * depth if it moves. Needs no model; docs/contact.md shows its use at 1 kHz.
/// @return non_finite_value or invalid_argument, which name the field. O(1), reentrant.
/// Source: Griffith 1921; for cutting with haptics Mahvash and Hayward 2001.
[[nodiscard]] SUNDER_API Result<BladeForce> blade_force(const CuttingResistance& tissue,
                                                        const BladeStep& step);

}  // namespace sunder
