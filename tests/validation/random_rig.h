#pragma once

#include <sunder/certificate/certificate.h>

#include <vector>

#include "support/machine/random.h"

namespace sunder::test {

/// A skeleton at bind with random joint limits.
struct RandomRig {
  Skeleton skeleton;
  ModelPose bind;
  JointLimits limits;
};

struct RandomRigKind {
  std::uint32_t most_bones = 10;
  double most_angle = 3.2;  ///< Radians.
  bool has_hinges = true, has_slides = true, has_scales = true;
  bool has_roots = false;  ///< More than one.
};

[[nodiscard]] RandomRig make_random_rig(Random& random, const RandomRigKind& kind);

/// A pose within the limits, half of the time at their ends: model_from_bone, multiplied down the
/// tree from each bone's motion.
[[nodiscard]] std::vector<Affine3d> random_pose_within(Random& random, const RandomRig& rig);

/// Bones and weights of a point; the weights sum to one.
struct RandomWeights {
  std::vector<std::uint32_t> bones;
  std::vector<double> weights;
};
[[nodiscard]] RandomWeights random_weights(Random& random, std::uint32_t bones);

/// By the definition of linear blend skinning.
[[nodiscard]] Vec3d posed_point(const RandomRig& rig, const std::vector<Affine3d>& model_from_bone,
                                const RandomWeights& weights, const Vec3d& position);

/// Appends factor * (posed point) to a row under construction.
void add_terms(const RandomWeights& weights, const Vec3d& position, double factor,
               std::vector<SkinTerm>& terms);

/// Closes a row: sorts and merges.
void append_row(std::vector<SkinTerm> terms, SkinDifferences& rows);

[[nodiscard]] JointTree make_tree(const RandomRig& rig);

}  // namespace sunder::test
