#pragma once

#include <sunder/particles/soft_body.h>

#include <vector>

namespace sunder {

struct ForceTearingOptions {
  double length = 0.5;  ///< Greatest length of a tear per call, as a fraction of the particles'
                        ///< range; in (0, 2].
};

struct ForceTearingReport {
  /// Greatest stretch of awake neighbours: their distance relative to rest. Neighbours closer at
  /// rest than seeds can be count as if they had the distance of seeds.
  double greatest_stretch = 0.0;
  /// Greatest energy that a tip with a toughness would release by running on, joules per metre.
  double greatest_release = 0.0;
  bool has_torn = false;
  bool is_from_tip = false;     ///< Whether the tear continues an older one.
  Vec3d place = Vec3d::Zero();  ///< Start of the tear on the posed surface; model space, metres.
  Vec3d direction = Vec3d::Zero();  ///< Direction of the tear; unit length.
  TearReport tear;
};

/// Tears the tissue across the direction of the greatest stretch. A tip in a material with a
/// toughness runs on if that releases at least as much energy (Griffith). Elsewhere the tissue
/// tears where it is stretched beyond its strength: from the tip of a tear near the most stretched
/// neighbours, or between them. Call it after SoftBody::step(). The tear is an operation in the
/// history, which can be undone and replayed. Deterministic; one thread at a time per model.
///
/// @param body       its materials have strengths and toughnesses; of two neighbours the lower one
///                   applies.
/// @param particles  those of the body; they follow the tear.
/// @param model      torn by at most one operation.
/// @param pose       that of the last step.
/// @param changes    optional; the record of the tear is appended.
/// @return invalid_argument for the options; the failure of the tear (nothing is changed);
///         limit_exceeded if out of memory. O(awake particles x neighbours) without a tear; if a
///         material has a toughness and something is awake, also O(edges of lips), and allocates;
///         with a tear, also its cost and that of its repair.
SUNDER_API Result<ForceTearingReport> tear_overstretched(
    const SoftBody& body, ParticleSet& particles, TornModel& model, const ModelPose& pose,
    const ForceTearingOptions& options = {}, std::vector<ChangeRecord>* changes = nullptr);

}  // namespace sunder
