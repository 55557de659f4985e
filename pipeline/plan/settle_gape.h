#pragma once

#include <sunder/plan/plan.h>

#include <memory>

#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// Chooses the tension under which the wound of a tear gapes as wide as wanted, where it is widest
/// or all along the curve: tears a copy of the character as soft tissue, lets it come to rest, and
/// corrects the tension by what it does.
/// @param path  its gape is wanted; TargetPath::wants_gape().
/// @return the failures of apply_operation(), of the material, and of ParticleSet::create().
[[nodiscard]] Result<PlannedGape> settle_gape(const std::shared_ptr<const Character>& character,
                                              const TearOperation& tear, const ModelPose& pose,
                                              const TargetPath& path, const SoftMaterial& material);

}  // namespace sunder::plan
