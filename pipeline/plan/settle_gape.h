#pragma once

#include <sunder/plan/plan.h>

#include <memory>

namespace sunder::plan {

/// Chooses the tension under which the wound of a tear gapes as wide as wanted: tears a copy of the
/// character as soft tissue, lets it come to rest, and corrects the tension by what it does.
/// @param length  of the wound, metres.
/// @param gape    wanted, metres, > 0.
/// @return the failures of apply_operation(), of the material, and of ParticleSet::create().
[[nodiscard]] Result<PlannedGape> settle_gape(const std::shared_ptr<const Character>& character,
                                              const TearOperation& tear, const ModelPose& pose,
                                              double length, double gape,
                                              const SoftMaterial& material);

}  // namespace sunder::plan
