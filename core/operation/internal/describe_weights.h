#pragma once

#include <sunder/operation/operation.h>

#include "core/operation/internal/field.h"
#include "core/operation/internal/field_ranges.h"

// Poses, and how vertices are weighted.

namespace sunder {

inline constexpr std::uint32_t kMaximumClipSamples = 65'536;

template <class V>
void describe(V& v, Is<ClipPose> auto& of) {
  v({"clip", "Name or index of the clip; without its namespace if one clip alone has the name.",
     Use::required},
    of.clip, Name{});
  v({"time", "Seconds.", Use::required}, of.time, field::kTime);
}

template <class V>
void describe(V& v, Is<BonesPose::Bone> auto& of) {
  v({"translation", "Relative to the parent.", Use::if_set}, of.translation);
  v({"rotation", "Quaternion x, y, z, w; normalised when read, not of zero length.", Use::if_set},
    of.rotation);
  v({"scale", "Along the bone's axes.", Use::if_set}, of.scale);
}

template <class V>
void describe(V& v, Is<ModelPose> auto& of) {
  v({"matrices", "One 3 x 4 matrix per bone, row by row.", Use::required}, of.model_from_bone,
    List{"matrices"});
  v({"morph_weights", "One per morph target; may be left out if the model has none."},
    of.morph_weights, List{"numbers"});
}

template <class V>
void describe(V& v, Is<WeightOptions> auto& of) {
  v({"policy", "How a vertex that an operation creates is skinned"}, of.policy);
  v({"influences", "Number of influences that a point keeps, the largest. 0: all."},
    of.maximum_influences, Integer{"influences, 0 for all", 0, kNone});
}

template <class V>
void describe(V& v, Is<JointLimit> auto& of) {
  v({"bone", "Its index.", Use::required}, of.bone, Integer{"a bone's index"});
  v({"axis", "In the bone's own frame, of any length except zero.", Use::required}, of.axis,
    Direction{"axis"});
  v({"lower", "Radians about rest.", Use::required}, of.lower, field::kLimitRadians);
  v({"upper", "Radians about rest, not below `lower`.", Use::required}, of.upper,
    field::kLimitRadians);
}

template <class V>
void describe(V& v, Is<PoseSetSpec> auto& of) {
  v({"clip_samples", "Largest number of poses taken from each clip, at equal steps of motion"},
    of.clip_samples, Integer{"samples a clip", 0, kMaximumClipSamples});
  v({"range_of_motion", "Adds poses in which each bone that deforms a mesh is turned"},
    of.range_of_motion);
  v({"joint_limits", "Bones that turn about one axis only"}, of.joint_limits, List{});
  v({"poses", "Poses as below; every fourth is held out."}, of.poses, List{});
}

template <class V>
void describe(V& v, Is<RefitImportance::OfClip> auto& of) {
  v({"clip", "Its name.", Use::required}, of.clip, Name{true});
  v({"factor", "Its importance among the clips.", Use::required}, of.factor, field::importance());
}

template <class V>
void describe(V& v, Is<RefitImportance> auto& of) {
  v({"clips", "All clips together."}, of.clips, field::importance());
  v({"of_clip", "Single clips among them."}, of.of_clip, List{});
  v({"range_of_motion", "The range of motion, or the limited joints."}, of.range_of_motion,
    field::importance());
  v({"poses", "The given poses."}, of.poses, field::importance());
}

template <class V>
void describe(V& v, Is<RefitOptions> auto& of) {
  v({"poses", "The poses over which errors are reduced"}, of.poses);
  v({"importance", "How much they count"}, of.importance);
  v({"bound", "Largest factor by which the certified worst deviation may grow"}, of.bound,
    field::kBound);
  v({"moves_bind", "Whether bind positions are fitted too."}, of.moves_bind);
  v({"coupled", "Whether neighbours are fitted together."}, of.is_coupled);
  v({"smoothness", "How much neighbours may differ if they are fitted together"}, of.smoothness,
    field::kSmoothness);
}

}  // namespace sunder
