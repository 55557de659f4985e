#include "pipeline/validation/checks/skeleton_checks.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"

namespace sunder::validation {
namespace {

/// Root mean square distance of places from their mean.
double spread_of(const std::vector<Vec3d>& places) {
  if (places.empty()) return 0.0;
  Vec3d mean = Vec3d::Zero();
  for (const Vec3d& place : places) mean += place;
  mean /= static_cast<double>(places.size());
  double square = 0.0;
  for (const Vec3d& place : places) square += squared_norm(place - mean);
  return std::sqrt(square / static_cast<double>(places.size()));
}

/// How far two transforms move a point at a distance `reach` from their origin apart.
double distance_between(const Affine3d& a, const Affine3d& b, double reach) {
  return norm(a.translation() - b.translation()) + reach * norm(a.linear() - b.linear());
}

/// bone_from_bind of a bone in the skins of a character; several where skins bind it differently.
std::vector<Affine3d> binds_of(const Character& character, Index bone) {
  std::vector<Affine3d> binds;
  for (const Skin& skin : character.skins)
    for (std::size_t slot = 0; slot < skin.bones.size(); ++slot)
      if (skin.bones[slot] == bone) binds.emplace_back(skin.bone_from_bind[slot].cast<double>());
  return binds;
}

FindingPlace place_of_bone(Index bone, const ModelPose& bind, double value) {
  FindingPlace place;
  place.bone = bone;
  place.position = bind.model_from_bone[bone].translation();
  place.value = value;
  return place;
}

/// The distance of each bone's bind matrices, in the target, from the nearest of the source's.
std::vector<double> bind_differences(const RowReader& reader, double reach) {
  const Character &source = reader.source().character, &target = reader.target().character;
  std::vector<double> differences(target.skeleton.bones.size(), 0.0);
  for (Index bone = 0; bone < differences.size(); ++bone) {
    const Index counterpart = reader.bones().source_of_target[bone];
    if (counterpart == kNone) continue;
    const std::vector<Affine3d> of_source = binds_of(source, counterpart);
    for (const Affine3d& bind : binds_of(target, bone)) {
      double least = std::numeric_limits<double>::infinity();
      for (const Affine3d& other : of_source)
        least = std::min(least, distance_between(bind, other, reach));
      if (!of_source.empty()) differences[bone] = std::max(differences[bone], least);
    }
  }
  return differences;
}

void check_binds(const RowReader& reader, const ModelPose& bind,
                 const std::vector<double>& differences, FindingList& findings) {
  const double least = kind_of(Code::bind).threshold * reader.source().surface.diagonal;
  Places places;
  for (Index bone = 0; bone < differences.size(); ++bone)
    if (differences[bone] > least) places.push_back(place_of_bone(bone, bind, differences[bone]));
  findings.add(Code::bind, std::move(places));
}

Affine3d affine_of(const BoneTransform& transform) {
  Affine3d affine;
  affine.linear() = transform.rotation.cast<double>().toRotationMatrix() *
                    Eigen::Vector3d(transform.scale.cast<double>()).asDiagonal();
  affine.translation() = transform.translation.cast<double>();
  return affine;
}

/// Bones that stand otherwise beside their parents; where parents differ, in model space.
void check_default_pose(const RowReader& reader, const ModelPose& bind, double reach,
                        FindingList& findings) {
  const Character &source = reader.source().character, &target = reader.target().character;
  const double least = kind_of(Code::default_pose).threshold * reader.source().surface.diagonal;
  const ModelPose of_source = or_throw(rest_pose(source)), of_target = or_throw(rest_pose(target));
  Places places;
  for (Index bone = 0; bone < target.skeleton.bones.size(); ++bone) {
    const Index counterpart = reader.bones().source_of_target[bone];
    if (counterpart == kNone) continue;
    const Index parent = target.skeleton.bones[bone].parent,
                other = source.skeleton.bones[counterpart].parent;
    const bool same_parent =
        parent == kNone ? other == kNone : reader.bones().source_of_target[parent] == other;
    const double difference =
        same_parent ? distance_between(affine_of(target.skeleton.bones[bone].rest),
                                       affine_of(source.skeleton.bones[counterpart].rest), reach)
                    : distance_between(of_target.model_from_bone[bone],
                                       of_source.model_from_bone[counterpart], reach);
    if (difference > least) places.push_back(place_of_bone(bone, bind, difference));
  }
  findings.add(Code::default_pose, std::move(places));
}

/// The largest distance of matched bones over a clip, in metres.
double clip_difference(const RowReader& reader, const Clip& source, const Clip& target) {
  constexpr int kSamples = 8;
  const Character &a = reader.source().character, &b = reader.target().character;
  Pose pose_a = or_throw(local_rest_pose(a)), pose_b = or_throw(local_rest_pose(b));
  ModelPose model_a, model_b;
  const auto start = [](const Character& of, ModelPose& model) {
    return compute_model_pose(of.skeleton, or_throw(local_rest_pose(of)), model).is_ok();
  };
  if (!start(a, model_a) || !start(b, model_b)) return 0.0;
  const ModelPose rest_a = model_a, rest_b = model_b;
  double largest = 0.0;
  for (int i = 0; i <= kSamples; ++i) {
    const double time = static_cast<double>(source.duration) * i / kSamples;
    if (!sample_clip(source, time, pose_a) || !sample_clip(target, time, pose_b) ||
        !compute_model_pose(a.skeleton, pose_a, model_a) ||
        !compute_model_pose(b.skeleton, pose_b, model_b))
      return 0.0;
    for (Index bone = 0; bone < b.skeleton.bones.size(); ++bone) {
      const Index other = reader.bones().source_of_target[bone];
      if (other == kNone) continue;
      // Relative to rest, so that another default pose alone is no difference of the clip.
      const Vec3d moved_a = model_a.model_from_bone[other].translation() -
                            rest_a.model_from_bone[other].translation(),
                  moved_b = model_b.model_from_bone[bone].translation() -
                            rest_b.model_from_bone[bone].translation();
      largest = std::max(largest, norm(moved_a - moved_b));
    }
  }
  return largest;
}

void check_clips(const RowReader& reader, FindingList& findings) {
  const auto &of_source = reader.source().character.clips,
             &of_target = reader.target().character.clips;
  if (of_source.empty()) return findings.not_tested(Code::clips, "the source has no clips");
  std::string faults;
  double count = 0;
  for (std::size_t i = 0; i < of_source.size(); ++i) {
    const Clip& clip = of_source[i];
    const auto same = std::ranges::find(of_target, clip.name, &Clip::name);
    const std::string name = "'" + clip.name + "'";
    std::string fault;
    if (same == of_target.end())
      fault = name + " is missing";
    else if (std::abs(same->duration - clip.duration) > 1e-3f * (1.0f + clip.duration))
      fault = name + " lasts " + std::to_string(same->duration) + " s, not " +
              std::to_string(clip.duration) + " s";
    else if (const double far = clip_difference(reader, clip, *same);
             far > 1e-3 * reader.source().surface.diagonal)
      fault = name + " moves bones up to " + std::to_string(far) + " m otherwise";
    if (!fault.empty() && ++count <= 8) faults += (faults.empty() ? "" : ", ") + fault;
  }
  if (count == 0) return findings.add(Code::clips, {});
  findings.add_finding(Code::clips, kind_of(Code::clips).severity, Evidence::sampled,
                       "Clips: " + faults + ".", {}, count);
}

}  // namespace

double find_scale(const Skinned& source, const Skinned& target, const BoneMatch& bones) {
  const double of_source = source.surface.diagonal, of_target = target.surface.diagonal;
  if (!(of_source > 0.0) || !(of_target > 0.0)) return 1.0;
  const double scale = of_target / of_source;
  const double limit = kind_of(Code::scale).threshold;
  if (scale < limit && scale > 1.0 / limit) return 1.0;
  const ModelPose bind_source = or_throw(bind_pose(source.character)),
                  bind_target = or_throw(bind_pose(target.character));
  std::vector<Vec3d> places_source, places_target;
  for (Index bone = 0; bone < target.character.skeleton.bones.size(); ++bone) {
    if (bones.source_of_target[bone] == kNone) continue;
    places_source.emplace_back(
        bind_source.model_from_bone[bones.source_of_target[bone]].translation());
    places_target.emplace_back(bind_target.model_from_bone[bone].translation());
  }
  const double spread = spread_of(places_source);
  if (!(spread > 1e-3 * of_source)) return scale;  // one bone says nothing of lengths
  const double of_bones = spread_of(places_target) / spread;
  return std::abs(of_bones / scale - 1.0) < 0.05 ? scale : 1.0;
}

Character divided_by(const Character& character, double scale) {
  Character divided = character;
  const auto factor = static_cast<float>(1.0 / scale);
  for (Mesh& mesh : divided.meshes) {
    for (Vec3f& position : mesh.positions) position *= factor;
    for (MorphTarget& morph : mesh.morph_targets)
      for (Vec3f& delta : morph.position_deltas) delta *= factor;
  }
  for (Bone& bone : divided.skeleton.bones) bone.rest.translation *= factor;
  for (Skin& skin : divided.skins)
    for (Affine3f& bind : skin.bone_from_bind) bind.translation() *= factor;
  for (Clip& clip : divided.clips)
    for (Channel& channel : clip.channels)
      if (channel.target == ChannelTarget::translation)
        for (float& value : channel.values) value *= factor;
  return divided;
}

void check_skeletons(const RowReader& reader, FindingList& findings) {
  const double reach = 0.1 * reader.source().surface.diagonal;
  const ModelPose bind = or_throw(bind_pose(reader.target().character));
  check_binds(reader, bind, bind_differences(reader, reach), findings);
  check_default_pose(reader, bind, reach, findings);
  check_clips(reader, findings);
}

}  // namespace sunder::validation
