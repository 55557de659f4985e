#pragma once

#include <sunder/particles/soft_body.h>

#include <vector>

namespace sunder {

struct ForceTearingOptions {
  double length = 0.5;  ///< Greatest length of a tear per call, as a fraction of the particles'
                        ///< range; in (0, 2].
};

struct ForceTearingReport {
  /// Greatest stretch of the awake neighbours: their distance relative to rest. Neighbours that are
  /// nearer at rest than seeds may be count as if they were as far apart as those.
  double greatest_stretch = 0.0;
  bool has_torn = false;
  bool is_from_tip = false;         ///< The tear continues an older one; else it is new.
  Vec3d place = Vec3d::Zero();      ///< Where it began on the posed surface; model space, metres.
  Vec3d direction = Vec3d::Zero();  ///< In which it ran; unit length.
  TearReport tear;
};

/// Tears the tissue where it is stretched beyond the strength of its material, across the direction
/// of the greatest stretch: from the tip of a tear near the most stretched neighbours, or between
/// them. To be called after SoftBody::step(). The tear is an operation like any stroke: it is in
/// the history, and can be undone and replayed. Deterministic; one thread at a time per model.
///
/// @param body       its materials have the strengths; the lesser of two neighbours counts.
/// @param particles  those of the body; they follow the tear.
/// @param model      torn by at most one operation.
/// @param pose       that of the last step.
/// @param changes    where given, the record of the tear is appended.
/// @return invalid_argument for the options; why the tear was refused (nothing is changed);
/// limit_exceeded out of memory. O(awake particles x neighbours) where nothing tears; else the cost
/// of a tear, its repair, and O(points of lips).
SUNDER_API Result<ForceTearingReport> tear_overstretched(
    const SoftBody& body, ParticleSet& particles, TornModel& model, const ModelPose& pose,
    const ForceTearingOptions& options = {}, std::vector<ChangeRecord>* changes = nullptr);

}  // namespace sunder
