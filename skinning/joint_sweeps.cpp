#include "skinning/joint_sweeps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/internal/ordered.h"
#include "core/internal/rotation_about.h"
#include "skinning/internal/bone_tree.h"

namespace sunder::skinning {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// The angles of a hinge. No angle of `fit` is held out, and none is zero, which is rest.
struct HingeAngles {
  std::vector<double> fit, held_out;  // ascending
  std::vector<double> ends;           // used together with a parent that rotates too
  double far_end = 0;                 // the limit that is farther from rest
  double before_far_end = 0;          // held out; equal to far_end if there is no angle before it
};

HingeAngles free_angles() {
  HingeAngles angles;
  for (const int degrees : {-90, -60, -30, 30, 60, 90}) angles.fit.push_back(degrees * kDegree);
  for (const int degrees : {-75, -45, 45, 75}) angles.held_out.push_back(degrees * kDegree);
  angles.ends = {60 * kDegree, -60 * kDegree};
  angles.far_end = 60 * kDegree;
  angles.before_far_end = 45 * kDegree;
  return angles;
}

/// Fractions of the way from rest, or from the limit nearest to it if the limits exclude it, to
/// each limit: a half and all of it to fit, a quarter and three quarters held out.
HingeAngles limited_angles(const JointLimit& limit) {
  const double nearest = std::clamp(0.0, limit.lower, limit.upper);
  const auto towards = [&](double end, double part) { return nearest + part * (end - nearest); };
  HingeAngles angles;
  if (limit.lower < nearest) {
    angles.fit = {limit.lower, towards(limit.lower, 0.5)};
    angles.held_out = {towards(limit.lower, 0.75), towards(limit.lower, 0.25)};
  }
  if (nearest != 0) angles.fit.push_back(nearest);
  if (limit.upper > nearest) {
    angles.fit.insert(angles.fit.end(), {towards(limit.upper, 0.5), limit.upper});
    angles.held_out.insert(angles.held_out.end(),
                           {towards(limit.upper, 0.25), towards(limit.upper, 0.75)});
  }
  if (limit.upper != 0) angles.ends.push_back(limit.upper);
  if (limit.lower != 0 && limit.lower != limit.upper) angles.ends.push_back(limit.lower);
  angles.far_end = std::abs(limit.lower) > std::abs(limit.upper) ? limit.lower : limit.upper;
  angles.before_far_end = towards(angles.far_end, 0.75);
  return angles;
}

/// Finds which bones move vertices, and which change a shape when they rotate: some bones of a mesh
/// rotate with them and some do not.
struct BoneEffects {
  std::vector<bool> moves_vertices, changes_shape;
};

BoneEffects find_effects(const Character& character) {
  const auto& bones = character.skeleton.bones;
  BoneEffects effects{std::vector<bool>(bones.size(), false),
                      std::vector<bool>(bones.size(), false)};
  std::vector<Index> used_below(
      bones.size());  // number of bones of the mesh at and below each bone
  for (const Mesh& mesh : character.meshes) {
    const Skin& skin = character.skins[mesh.skin];
    std::fill(used_below.begin(), used_below.end(), 0u);
    for (const Influence& influence : mesh.weights.influences)
      if (influence.weight > 0) used_below[skin.bones[influence.slot]] = 1;
    const auto used = static_cast<Index>(std::count(used_below.begin(), used_below.end(), 1u));
    for (std::size_t bone = bones.size(); bone-- > 0;) {  // children before parents
      if (used_below[bone] == 0) continue;
      if (used_below[bone] < used) effects.changes_shape[bone] = true;
      if (bones[bone].parent != kNone) used_below[bones[bone].parent] += used_below[bone];
    }
    for (const Influence& influence : mesh.weights.influences)
      if (influence.weight > 0) effects.moves_vertices[skin.bones[influence.slot]] = true;
  }
  return effects;
}

class SweepMaker {
 public:
  SweepMaker(const Character& character, const PoseSetSpec& spec)
      : bones_(character.skeleton.bones) {
    const BoneEffects effects = find_effects(character);
    std::vector<std::vector<Index>> limits_of(bones_.size());
    for (Index i = 0; i < spec.joint_limits.size(); ++i)
      limits_of[spec.joint_limits[i].bone].push_back(i);
    first_hinge_.push_back(0);
    for (Index bone = 0; bone < bones_.size(); ++bone) {
      if (effects.changes_shape[bone]) {
        for (const Index limit : limits_of[bone])
          add_hinge(bone, spec.joint_limits[limit].axis.stableNormalized(),
                    limited_angles(spec.joint_limits[limit]));
        if (limits_of[bone].empty() && spec.range_of_motion && effects.moves_vertices[bone])
          for (const Vec3d& axis : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)})
            add_hinge(bone, axis, free_angles());
      }
      first_hinge_.push_back(static_cast<Index>(sweeps_.hinges.size()));
    }
    for (Index bone = 0; bone < bones_.size(); ++bone) add_sweeps(bone);
    sweeps_.fit.shrink_to_fit();  // large, and kept
    sweeps_.held_out.shrink_to_fit();
  }

  [[nodiscard]] JointSweeps take() { return std::move(sweeps_); }

 private:
  void add_hinge(Index bone, const Vec3d& axis, HingeAngles angles) {
    if (angles.fit.empty()) return;  // the limits allow only rest
    sweeps_.hinges.push_back({bone, axis});
    angles_.push_back(std::move(angles));
  }

  void add_sweeps(Index bone) {
    const Index begin = first_hinge_[bone], count = first_hinge_[bone + 1] - begin;
    for (Index hinge = begin; hinge < begin + count; ++hinge) {
      for (const double angle : angles_[hinge].fit) sweeps_.fit.push_back({{hinge, angle}, {}});
      for (const double angle : angles_[hinge].held_out)
        sweeps_.held_out.push_back({{hinge, angle}, {}});
    }
    const Index parent = bones_[bone].parent;
    if (parent == kNone || count == 0) return;
    const Index parent_begin = first_hinge_[parent],
                parent_count = first_hinge_[parent + 1] - parent_begin;
    if (parent_count == 0) return;
    for (Index i = 0; i < std::max(count, parent_count);
         ++i) {  // x with x, y with y; held out x with y, y with z
      const Index own = begin + i % count;
      const Index same = parent_begin + i % parent_count,
                  other = parent_begin + (i + 1) % parent_count;
      for (const double end : angles_[same].ends)
        sweeps_.fit.push_back({{own, angles_[own].far_end}, {same, end}});
      // Two joints with only one angle each have no second pose.
      const bool is_fixed = angles_[own].held_out.empty() && angles_[other].held_out.empty();
      if (!is_fixed)
        sweeps_.held_out.push_back(
            {{own, angles_[own].before_far_end}, {other, angles_[other].before_far_end}});
    }
  }

  const std::vector<Bone>& bones_;
  std::vector<Index> first_hinge_;   // per bone, and the end
  std::vector<HingeAngles> angles_;  // per hinge
  JointSweeps sweeps_;
};

}  // namespace

JointSweeps make_joint_sweeps(const Character& character, const PoseSetSpec& spec) {
  if (!spec.range_of_motion && spec.joint_limits.empty()) return {};
  return SweepMaker(character, spec).take();
}

void compute_sweep(const Character& character, const JointSweeps& sweeps, const Sweep& sweep,
                   ModelPose& pose) {
  const auto& bones = character.skeleton.bones;
  pose.model_from_bone.resize(bones.size());
  const auto turned = [&](std::size_t bone) {
    BoneTransform local = bones[bone].rest;
    for (const Turn& turn : {sweep.bone, sweep.parent}) {
      if (turn.hinge == kNone || sweeps.hinges[turn.hinge].bone != bone) continue;
      const Quatd rotation = rotation_about(turn.angle, sweeps.hinges[turn.hinge].axis);
      local.rotation = normalized(multiply(local.rotation.cast<double>(), rotation)).cast<float>();
    }
    return local;
  };
  multiply_down(character.skeleton, turned, pose.model_from_bone);
  pose.morph_weights = character.rest_morph_weights;
}

}  // namespace sunder::skinning
