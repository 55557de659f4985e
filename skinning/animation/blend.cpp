#include <sunder/animation/blend.h>

#include <algorithm>
#include <cmath>

#include "core/internal/out_of_memory.h"
#include "skinning/animation/transform_blend.h"

namespace sunder {
namespace {

bool is_share(float value) { return value >= 0.0f && value <= 1.0f; }

Status check_sizes(std::size_t bones, std::size_t morph_weights, const Pose& pose,
                   const char* other) {
  if (pose.parent_from_bone.size() != bones)
    return Status::failure(StatusCode::size_mismatch, kNone, "the pose has %zu bones, the %s %zu",
                           pose.parent_from_bone.size(), other, bones);
  if (pose.morph_weights.size() != morph_weights)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu morph weights, the %s %zu", pose.morph_weights.size(),
                           other, morph_weights);
  return {};
}

Status check_weight(float weight, const BoneMask* mask, std::size_t bones) {
  if (!is_share(weight))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the weight is %g, but must be in [0, 1]", static_cast<double>(weight));
  if (mask == nullptr) return {};
  if (mask->bones.size() != bones)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the mask has %zu bones, the pose has %zu", mask->bones.size(), bones);
  for (std::uint32_t bone = 0; bone < bones; ++bone)
    if (!is_share(mask->bones[bone]))
      return Status::failure(StatusCode::invalid_argument, bone,
                             "the mask of bone %u is %g, but must be in [0, 1]", bone,
                             static_cast<double>(mask->bones[bone]));
  if (!is_share(mask->morph_weights))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the mask of morph weights is %g, but must be in [0, 1]",
                           static_cast<double>(mask->morph_weights));
  return {};
}

Status check_blend(std::span<const Pose* const> poses, std::span<const float> weights) {
  if (poses.empty())
    return Status::failure(StatusCode::empty_input, kNone, "there is no pose to blend");
  if (poses.size() != weights.size())
    return Status::failure(StatusCode::size_mismatch, kNone, "%zu poses have %zu weights",
                           poses.size(), weights.size());
  bool are_all_zero = true;
  for (std::uint32_t i = 0; i < poses.size(); ++i) {
    if (poses[i] == nullptr)
      return Status::failure(StatusCode::invalid_argument, i, "pose %u is null", i);
    if (const Status status = check_sizes(poses[0]->parent_from_bone.size(),
                                          poses[0]->morph_weights.size(), *poses[i], "first pose");
        !status)
      return status;
    if (!std::isfinite(weights[i]) || weights[i] < 0.0f)
      return Status::failure(StatusCode::invalid_argument, i,
                             "weight %u is %g, but must be finite and >= 0", i,
                             static_cast<double>(weights[i]));
    are_all_zero &= weights[i] == 0.0f;
  }
  if (are_all_zero)
    return Status::failure(StatusCode::invalid_argument, kNone, "all weights are zero");
  return {};
}

/// Weights as shares of their sum, and the heaviest pose.
class Shares {
 public:
  Shares(std::span<const Pose* const> poses, std::span<const float> weights)
      : poses_(poses), weights_(weights) {
    for (const float weight : weights) sum_ += static_cast<double>(weight);
    heaviest_ = static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) -
                                         weights.begin());
  }

  /// @param value  of a pose, in double.
  template <class Value>
  [[nodiscard]] auto mean(const Value& value) const {
    auto sum = (share(0) * value(*poses_[0])).eval();
    for (std::size_t i = 1; i < poses_.size(); ++i) sum += share(i) * value(*poses_[i]);
    return sum;
  }

  [[nodiscard]] double mean_morph(std::size_t weight) const {
    double sum = 0;
    for (std::size_t i = 0; i < poses_.size(); ++i)
      sum += share(i) * static_cast<double>(poses_[i]->morph_weights[weight]);
    return sum;
  }

  [[nodiscard]] Quatf rotation(std::size_t bone) const {
    const auto rotation_of = [&](const Pose& pose) -> Vec4d {
      return unit(pose.parent_from_bone[bone].rotation).coeffs().cast<double>();
    };
    const Vec4d heaviest = rotation_of(*poses_[heaviest_]);
    const Vec4d sum = mean([&](const Pose& pose) -> Vec4d {
      const Vec4d one = rotation_of(pose);
      return dot(heaviest, one) < 0.0 ? Vec4d(-one) : one;
    });
    // All are in the closed hemisphere of the heaviest one, whose own share is not zero.
    return Quatf(Vec4f(normalized(sum).cast<float>()));
  }

 private:
  [[nodiscard]] double share(std::size_t i) const {
    return static_cast<double>(weights_[i]) / sum_;
  }

  std::span<const Pose* const> poses_;
  std::span<const float> weights_;
  double sum_ = 0;
  std::size_t heaviest_ = 0;
};

}  // namespace

Result<BoneMask> subtree_mask(const Skeleton& skeleton, std::uint32_t bone, float inside,
                              float outside) {
  if (bone >= skeleton.bones.size())
    return Status::failure(StatusCode::index_out_of_range, bone,
                           "bone %u does not exist; the skeleton has %zu", bone,
                           skeleton.bones.size());
  if (!is_share(inside) || !is_share(outside))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "a mask of %g and %g: both must be in [0, 1]",
                           static_cast<double>(inside), static_cast<double>(outside));
  return or_out_of_memory([&]() -> Result<BoneMask> {
    BoneMask mask;
    mask.bones.assign(skeleton.bones.size(), outside);
    mask.morph_weights = outside;
    std::vector<bool> is_inside(skeleton.bones.size(), false);
    for (std::size_t i = bone; i < is_inside.size(); ++i) {
      const std::uint32_t parent = skeleton.bones[i].parent;
      is_inside[i] = i == bone || (parent != kNone && is_inside[parent]);
      if (is_inside[i]) mask.bones[i] = inside;
    }
    return mask;
  });
}

Status blend(std::span<const Pose* const> poses, std::span<const float> weights, Pose& result) {
  if (const Status status = check_blend(poses, weights); !status) return status;
  return or_out_of_memory([&]() -> Status {
    const std::size_t bones = poses[0]->parent_from_bone.size();
    const std::size_t morphs = poses[0]->morph_weights.size();
    // Reserved first, so that a lack of memory leaves the result as it was. It may be one of the
    // poses: each value is read completely before it is written.
    result.parent_from_bone.reserve(bones);
    result.morph_weights.reserve(morphs);
    result.parent_from_bone.resize(bones);
    result.morph_weights.resize(morphs);
    const Shares shares(poses, weights);
    for (std::size_t bone = 0; bone < bones; ++bone) {
      BoneTransform mean;
      mean.translation = shares
                             .mean([&](const Pose& pose) -> Vec3d {
                               return pose.parent_from_bone[bone].translation.cast<double>();
                             })
                             .cast<float>();
      mean.scale = shares
                       .mean([&](const Pose& pose) -> Vec3d {
                         return pose.parent_from_bone[bone].scale.cast<double>();
                       })
                       .cast<float>();
      mean.rotation = shares.rotation(bone);
      result.parent_from_bone[bone] = mean;
    }
    for (std::size_t i = 0; i < morphs; ++i)
      result.morph_weights[i] = static_cast<float>(shares.mean_morph(i));
    return {};
  });
}

Status blend_towards(const Pose& other, float weight, Pose& pose, const BoneMask* mask) {
  const std::size_t bones = pose.parent_from_bone.size();
  if (const Status status =
          check_sizes(bones, pose.morph_weights.size(), other, "one that changes");
      !status)
    return status;
  if (const Status status = check_weight(weight, mask, bones); !status) return status;
  for (std::size_t bone = 0; bone < bones; ++bone)
    animation::blend_transform(other.parent_from_bone[bone],
                               mask == nullptr ? weight : weight * mask->bones[bone],
                               pose.parent_from_bone[bone]);
  const float share = mask == nullptr ? weight : weight * mask->morph_weights;
  for (std::size_t i = 0; i < pose.morph_weights.size(); ++i)
    pose.morph_weights[i] =
        share >= 1.0f
            ? other.morph_weights[i]
            : pose.morph_weights[i] + share * (other.morph_weights[i] - pose.morph_weights[i]);
  return {};
}

Status make_additive(const Pose& pose, const Pose& reference, PoseDelta& delta) {
  const std::size_t bones = pose.parent_from_bone.size(), morphs = pose.morph_weights.size();
  if (const Status status = check_sizes(bones, morphs, reference, "other one"); !status)
    return status;
  return or_out_of_memory([&]() -> Status {
    delta.bones.reserve(bones);
    delta.morph_weights.reserve(morphs);
    delta.bones.resize(bones);
    delta.morph_weights.resize(morphs);
    for (std::size_t bone = 0; bone < bones; ++bone)
      delta.bones[bone] =
          animation::delta_of(pose.parent_from_bone[bone], reference.parent_from_bone[bone]);
    for (std::size_t i = 0; i < morphs; ++i)
      delta.morph_weights[i] = pose.morph_weights[i] - reference.morph_weights[i];
    return {};
  });
}

Status add(const PoseDelta& delta, float weight, Pose& pose, const BoneMask* mask) {
  const std::size_t bones = delta.bones.size();
  if (const Status status = check_sizes(bones, delta.morph_weights.size(), pose, "difference");
      !status)
    return status;
  if (const Status status = check_weight(weight, mask, bones); !status) return status;
  for (std::size_t bone = 0; bone < bones; ++bone)
    animation::add_transform(delta.bones[bone],
                             mask == nullptr ? weight : weight * mask->bones[bone],
                             pose.parent_from_bone[bone]);
  const float share = mask == nullptr ? weight : weight * mask->morph_weights;
  for (std::size_t i = 0; i < pose.morph_weights.size(); ++i)
    pose.morph_weights[i] += share * delta.morph_weights[i];
  return {};
}

}  // namespace sunder
