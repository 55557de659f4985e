#pragma once

#include <sunder/certificate/certificate.h>

#include <span>
#include <vector>

#include "pipeline/validation/match/bone_match.h"

namespace sunder::validation {

/// A slot of a skin as the source's skeleton moves it.
struct DrivenSlot {
  Index bone = 0;            ///< Of the source.
  Affine3d model_from_bind;  ///< At the source's bind pose.
};

/// The slots of all skins of two models, so that vertices of both can be written as terms of the
/// source's skeleton. Bones of the target without a counterpart move with
/// BoneMatch::driver_of_target.
struct DrivenSkins {
  ModelPose bind;                                             ///< Of the source.
  std::vector<std::vector<DrivenSlot>> of_source, of_target;  ///< Per skin and slot.
};

/// The bind pose of the source on the target's bones; those without a counterpart keep their own.
/// O(bones), allocates.
[[nodiscard]] ModelPose driven_bind_pose(const ModelPose& source_bind, const Character& target,
                                         const BoneMatch& bones);

/// O(slots), allocates.
[[nodiscard]] DrivenSkins make_driven_skins(const Character& source, const Character& target,
                                            const BoneMatch& bones);

/// Sums the terms of one skinned point by bone, without a search.
class TermSum {
 public:
  explicit TermSum(std::size_t bone_count)
      : sums_(bone_count, Vec4d::Zero()), is_used_(bone_count, 0) {}

  void add(Index bone, double m, const Vec3d& x) {
    sums_[bone].head<3>() += x;
    sums_[bone][3] += m;
    if (is_used_[bone] == 0) used_.push_back(bone);
    is_used_[bone] = 1;
  }
  /// Adds `part` times a point at a place in bind space that follows some influences.
  void add_point(const Vec3d& place, std::span<const Influence> influences,
                 std::span<const DrivenSlot> slots, double part);
  /// Appends the terms that are not zero as one row and starts over.
  void finish(SkinDifferences& rows);

 private:
  std::vector<Vec4d> sums_;    // per bone of the source: x, m
  std::vector<char> is_used_;  // per bone of the source
  std::vector<Index> used_;
};

}  // namespace sunder::validation
