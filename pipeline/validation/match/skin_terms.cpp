#include "pipeline/validation/match/skin_terms.h"

#include <sunder/skinning/pose.h>

#include <algorithm>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"
#include "pipeline/validation/match/bind_surface.h"

namespace sunder::validation {

ModelPose driven_bind_pose(const ModelPose& source_bind, const Character& target,
                           const BoneMatch& bones) {
  ModelPose pose = or_throw(bind_pose(target));
  for (Index bone = 0; bone < pose.model_from_bone.size(); ++bone)
    if (const Index counterpart = bones.source_of_target[bone]; counterpart != kNone)
      pose.model_from_bone[bone] = source_bind.model_from_bone[counterpart];
  return pose;
}

DrivenSkins make_driven_skins(const Character& source, const Character& target,
                              const BoneMatch& bones) {
  DrivenSkins skins;
  skins.bind = or_throw(bind_pose(source));
  const auto palettes = bind_palettes(source, skins.bind);
  for (std::size_t skin = 0; skin < source.skins.size(); ++skin) {
    auto& slots = skins.of_source.emplace_back();
    for (std::size_t i = 0; i < palettes[skin].size(); ++i)
      slots.push_back({source.skins[skin].bones[i], palettes[skin][i]});
  }
  const auto driven = bind_palettes(target, driven_bind_pose(skins.bind, target, bones));
  for (std::size_t skin = 0; skin < target.skins.size(); ++skin) {
    auto& slots = skins.of_target.emplace_back();
    for (std::size_t i = 0; i < driven[skin].size(); ++i)
      slots.push_back({bones.driver_of_target[target.skins[skin].bones[i]], driven[skin][i]});
  }
  return skins;
}

void TermSum::add_point(const Vec3d& place, std::span<const Influence> influences,
                        std::span<const DrivenSlot> slots, double part) {
  for (const Influence& influence : influences) {
    const DrivenSlot& slot = slots[influence.slot];
    const double m = part * static_cast<double>(influence.weight);
    add(slot.bone, m, m * transform(slot.model_from_bind, place));
  }
}

void TermSum::finish(SkinDifferences& rows) {
  std::sort(used_.begin(), used_.end());
  for (const Index bone : used_) {
    if (!sums_[bone].isZero(0)) rows.terms.push_back({bone, sums_[bone][3], sums_[bone].head<3>()});
    sums_[bone].setZero();
    is_used_[bone] = 0;
  }
  used_.clear();
  rows.first.push_back(static_cast<Index>(rows.terms.size()));
}

}  // namespace sunder::validation
