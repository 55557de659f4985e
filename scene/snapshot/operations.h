#pragma once

#include <sunder/operation/operation.h>

#include "scene/snapshot/pose_memory.h"

namespace sunder::scene {

// The members of everything that an operation consists of. The structured bindings name all
// members, so that a new one is not forgotten here.

template <>
inline constexpr WeightPolicy kLastEnumerator<WeightPolicy> = WeightPolicy::exact;
template <>
inline constexpr Layers kLastEnumerator<Layers> = Layers::all;

template <class Archive>
void transfer(Archive&, RestPose&) {}
template <class Archive>
void transfer(Archive&, BindPose&) {}
template <class Archive>
void transfer(Archive& archive, ClipPose& of) {
  auto& [clip, time] = of;
  archive(clip, time);
}
template <class Archive>
void transfer(Archive& archive, BonesPose::Bone& of) {
  auto& [name, translation, rotation, scale] = of;
  archive(name, translation, rotation, scale);
}
template <class Archive>
void transfer(Archive& archive, BonesPose& of) {
  archive(of.bones);
}
template <class Archive>
void transfer(Archive& archive, ModelPose& of) {
  archive.poses->transfer_pose(archive, of);
}
template <class Archive>
void transfer(Archive& archive, JointLimit& of) {
  auto& [bone, axis, lower, upper] = of;
  archive(bone, axis, lower, upper);
}
template <class Archive>
void transfer(Archive& archive, PoseSetSpec& of) {
  auto& [clip_samples, range_of_motion, joint_limits, poses] = of;
  archive(clip_samples, range_of_motion, joint_limits, poses);
}
template <class Archive>
void transfer(Archive& archive, WeightOptions& of) {
  auto& [policy, maximum_influences] = of;
  archive(policy, maximum_influences);
}
template <class Archive>
void transfer(Archive& archive, RefitImportance::OfClip& of) {
  auto& [clip, factor] = of;
  archive(clip, factor);
}
template <class Archive>
void transfer(Archive& archive, RefitImportance& of) {
  auto& [clips, of_clip, range_of_motion, poses] = of;
  archive(clips, of_clip, range_of_motion, poses);
}
template <class Archive>
void transfer(Archive& archive, RefitOptions& of) {
  auto& [poses, importance, bound, moves_bind, is_coupled, smoothness] = of;
  archive(poses, importance, bound, moves_bind, is_coupled, smoothness);
}
template <class Archive>
void transfer(Archive& archive, Blade& of) {
  auto& [base, tip] = of;
  archive(base, tip);
}
template <class Archive>
void transfer(Archive& archive, TearOptions& of) {
  auto& [width, layers, wall_depth, weights, wall_material, lip_roll] = of;
  archive(width, layers, wall_depth, weights, wall_material, lip_roll);
}
template <class Archive>
void transfer(Archive& archive, SectionRay& of) {
  auto& [origin, direction] = of;
  archive(origin, direction);
}
template <class Archive>
void transfer(Archive& archive, PlaneCut& of) {
  auto& [point, normal, bounds, caps, sections, weights, first_hit, bone, cap_material] = of;
  archive(point, normal, bounds, caps, sections, weights, first_hit, bone, cap_material);
}
template <class Archive>
void transfer(Archive& archive, Bore& of) {
  auto& [origin, direction, radius, depth, chord_tolerance, wall, weights, wall_material] = of;
  archive(origin, direction, radius, depth, chord_tolerance, wall, weights, wall_material);
}
template <class Archive>
void transfer(Archive& archive, TearOperation::PoseChange& of) {
  auto& [blade, pose] = of;
  archive(blade, pose);
}
template <class Archive>
void transfer(Archive& archive, TearOperation& of) {
  auto& [pose, stroke, pose_changes, options] = of;
  archive(pose, stroke, pose_changes, options);
}
template <class Archive>
void transfer(Archive& archive, CutOperation& of) {
  auto& [pose, cut] = of;
  archive(pose, cut);
}
template <class Archive>
void transfer(Archive& archive, DrillOperation& of) {
  auto& [pose, bore] = of;
  archive(pose, bore);
}
template <class Archive>
void transfer(Archive& archive, PieceOfTriangle& of) {
  auto& [mesh, triangle] = of;
  archive(mesh, triangle);
}
template <class Archive>
void transfer(Archive& archive, PieceNear& of) {
  auto& [point, bone] = of;
  archive(point, bone);
}
template <class Archive>
void transfer(Archive& archive, DetachOperation& of) {
  auto& [pose, piece] = of;
  archive(pose, piece);
}
template <class Archive>
void transfer(Archive& archive, WeightsOperation& of) {
  auto& [first_operation, operation_count, weights, pose, refit] = of;
  archive(first_operation, operation_count, weights, pose, refit);
}
template <class Archive>
void transfer(Archive& archive, UndoOperation& of) {
  archive(of.count);
}
template <class Archive>
void transfer(Archive& archive, RedoOperation& of) {
  archive(of.count);
}

}  // namespace sunder::scene
