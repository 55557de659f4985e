#include "pipeline/validation/checks/pose_batches.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"

namespace sunder::validation {
namespace {

constexpr std::uint32_t kClipSamples = 8;
constexpr std::size_t kMostOfMotion = 48;  ///< Poses of a range of motion.
constexpr std::size_t kMostOfClips = 256;

/// Numbers in [0, 1) that are the same with every standard library.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// A unit vector, evenly distributed over the sphere.
  Vec3d direction() {
    for (;;) {
      const double x = 2 * (*this)() - 1, y = 2 * (*this)() - 1, z = 2 * (*this)() - 1;
      const Vec3d v(x, y, z);
      const double square = squared_norm(v);
      if (square > 0.01 && square < 1.0) return normalized(v);
    }
  }

 private:
  std::mt19937_64 engine_;
};

/// A turn about a point.
Affine3d turn_about(const Vec3d& center, const Vec3d& axis, double angle) {
  Affine3d turn;
  turn.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d(axis)).toRotationMatrix();
  turn.translation() = center - multiply(Mat3d(turn.linear()), center);
  return turn;
}

/// inverse(model_from_bone at bind) per bone.
std::vector<Affine3d> bones_from_model(const ModelPose& bind) {
  std::vector<Affine3d> inverses;
  for (const Affine3d& model_from_bone : bind.model_from_bone)
    inverses.push_back(model_from_bone.inverse(Eigen::Affine));
  return inverses;
}

/// The poses of a set, every n-th where there are more than `most`.
PoseBatch take_poses(std::string_view name, const PoseSet& set,
                     const std::vector<Affine3d>& bone_from_model, std::size_t most) {
  PoseBatch batch{name, false, {}};
  const std::size_t fit = set.size(PoseSet::Role::fit),
                    all = fit + set.size(PoseSet::Role::held_out);
  const std::size_t step = all / most + (all % most != 0);
  ModelPose pose;
  for (std::size_t i = 0; i < all; i += std::max<std::size_t>(step, 1)) {
    if (i < fit)
      or_throw(set.compute(PoseSet::Role::fit, i, pose));
    else
      or_throw(set.compute(PoseSet::Role::held_out, i - fit, pose));
    auto& matrices = batch.poses.emplace_back();
    for (std::size_t bone = 0; bone < bone_from_model.size(); ++bone)
      matrices.push_back(multiply(pose.model_from_bone[bone], bone_from_model[bone]));
  }
  return batch;
}

PoseBatch poses_of(std::string_view name, const std::shared_ptr<const Character>& source,
                   const std::vector<Affine3d>& bone_from_model, const PoseSetSpec& spec,
                   std::size_t most) {
  const Result<PoseSet> set = PoseSet::create(source, spec);
  return set ? take_poses(name, *set, bone_from_model, most) : PoseBatch{name, false, {}};
}

}  // namespace

namespace {

/// How each bone stands in the rest pose relative to its parent and to bind: the identity where the
/// rest pose is that of bind. Bones below a scale of zero count as not moved.
std::vector<Affine3d> rest_motions(const Character& source, const ModelPose& bind) {
  const ModelPose rest = or_throw(rest_pose(source));
  const std::vector<Affine3d> bone_from_model = bones_from_model(bind);
  const auto& bones = source.skeleton.bones;
  std::vector<Affine3d> motions(bones.size(), Affine3d::Identity()), from_bind = motions;
  for (std::size_t bone = 0; bone < bones.size(); ++bone) {
    from_bind[bone] = multiply(rest.model_from_bone[bone], bone_from_model[bone]);
    motions[bone] = bones[bone].parent == kNone
                        ? from_bind[bone]
                        : multiply(inverse(from_bind[bones[bone].parent]), from_bind[bone]);
    if (!motions[bone].matrix().allFinite()) motions[bone].setIdentity();
  }
  return motions;
}

}  // namespace

PoseBatch make_random_poses(const Character& source, const ModelPose& bind,
                            const ValidationOptions& options) {
  PoseBatch batch{"random", true, {}};
  Uniform uniform(options.seed);
  const auto& bones = source.skeleton.bones;
  const std::vector<Affine3d> rest = rest_motions(source, bind);
  for (std::uint32_t i = 0; i < options.random_poses; ++i) {
    auto& matrices = batch.poses.emplace_back(bones.size(), Affine3d::Identity());
    for (std::size_t bone = 0; bone < bones.size(); ++bone) {
      const Vec3d axis = uniform.direction();
      const bool at_limit = uniform() < 0.5;
      const double angle = at_limit ? options.random_angle : options.random_angle * uniform();
      const Vec3d center = bind.model_from_bone[bone].translation();
      const Affine3d turn = multiply(rest[bone], turn_about(center, axis, angle));
      matrices[bone] =
          bones[bone].parent == kNone ? turn : multiply(matrices[bones[bone].parent], turn);
    }
  }
  return batch;
}

std::vector<PoseBatch> make_pose_batches(const std::shared_ptr<const Character>& source,
                                         const ModelPose& bind, const ValidationOptions& options) {
  const std::vector<Affine3d> bone_from_model = bones_from_model(bind);
  PoseSetSpec clips, motion;
  clips.clip_samples = source->clips.empty() ? 0 : kClipSamples;
  motion.clip_samples = 0;
  motion.range_of_motion = true;
  std::vector<PoseBatch> batches;
  batches.push_back(source->clips.empty()
                        ? PoseBatch{"clips", false, {}}
                        : poses_of("clips", source, bone_from_model, clips, kMostOfClips));
  batches.push_back(poses_of("range of motion", source, bone_from_model, motion, kMostOfMotion));
  batches.push_back(make_random_poses(*source, bind, options));
  return batches;
}

ModelPose model_pose(const std::vector<Affine3d>& model_from_bind, const ModelPose& bind) {
  ModelPose pose;
  pose.morph_weights = bind.morph_weights;
  for (std::size_t bone = 0; bone < model_from_bind.size(); ++bone)
    pose.model_from_bone.push_back(multiply(model_from_bind[bone], bind.model_from_bone[bone]));
  return pose;
}

}  // namespace sunder::validation
