#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Divides a model into particles, and keeps its authored tissue. Structure::finish() is still to
/// be called.
/// @return as ParticleSet::create().
[[nodiscard]] Result<std::unique_ptr<Structure>> decompose_model(
    const TornModel& model, const ModelPose& pose, const DecompositionOptions& options,
    const AuthoredTissue& tissue);

}  // namespace sunder::particles
