#include "validation/match/skin_difference.h"

#include <sunder/skinning/pose.h>

#include <algorithm>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"

namespace sunder::validation {
namespace {

/// A slot of a skin as the source's skeleton moves it.
struct Slot {
  Index bone;  ///< Of the source.
  Affine3d model_from_bind;
};

std::vector<std::vector<Slot>> slots_of_source(const Character& source, const ModelPose& bind) {
  const auto palettes = bind_palettes(source, bind);
  std::vector<std::vector<Slot>> slots(source.skins.size());
  for (std::size_t skin = 0; skin < slots.size(); ++skin)
    for (std::size_t i = 0; i < palettes[skin].size(); ++i)
      slots[skin].push_back({source.skins[skin].bones[i], palettes[skin][i]});
  return slots;
}

std::vector<std::vector<Slot>> slots_of_target(const Character& target, const BoneMatch& bones,
                                               const ModelPose& source_bind) {
  const ModelPose own_bind = or_throw(bind_pose(target));
  std::vector<std::vector<Slot>> slots(target.skins.size());
  for (std::size_t skin = 0; skin < slots.size(); ++skin)
    for (std::size_t i = 0; i < target.skins[skin].bones.size(); ++i) {
      const Index bone = target.skins[skin].bones[i], counterpart = bones.source_of_target[bone];
      const Affine3d& model_from_bone = counterpart != kNone
                                            ? source_bind.model_from_bone[counterpart]
                                            : own_bind.model_from_bone[bone];
      slots[skin].push_back(
          {bones.driver_of_target[bone],
           multiply(model_from_bone,
                    Affine3d(target.skins[skin].bone_from_bind[i].cast<double>()))});
    }
  return slots;
}

/// Sums the terms of one row, by bone.
class Row {
 public:
  explicit Row(std::size_t bones) : sums_(bones, Vec4d::Zero()), is_used_(bones, false) {}

  void add(double part, const Mesh& mesh, Index vertex, const std::vector<Slot>& slots) {
    const Vec3d position = mesh.positions[vertex].cast<double>();
    for (const Influence& influence : mesh.weights.of(vertex)) {
      const Slot& slot = slots[influence.slot];
      const double weight = part * static_cast<double>(influence.weight);
      Vec4d& sum = sums_[slot.bone];
      sum.head<3>() += weight * transform(slot.model_from_bind, position);
      sum[3] += weight;
      if (!is_used_[slot.bone]) used_.push_back(slot.bone);
      is_used_[slot.bone] = true;
    }
  }

  /// Appends the terms that are not zero and starts over.
  void finish(SkinDifferences& differences) {
    std::sort(used_.begin(), used_.end());
    for (const Index bone : used_) {
      if (!sums_[bone].isZero(0))
        differences.terms.push_back({bone, sums_[bone][3], sums_[bone].head<3>()});
      sums_[bone].setZero();
      is_used_[bone] = false;
    }
    used_.clear();
    differences.first.push_back(static_cast<Index>(differences.terms.size()));
  }

 private:
  std::vector<Vec4d> sums_;
  std::vector<bool> is_used_;
  std::vector<Index> used_;
};

}  // namespace

SkinDifferences difference_of(const Character& source, const Character& target,
                              const SurfaceMatches& matches, const BoneMatch& bones) {
  const ModelPose bind = or_throw(bind_pose(source));
  const auto source_slots = slots_of_source(source, bind);
  const auto target_slots = slots_of_target(target, bones, bind);
  SkinDifferences differences;
  differences.first.reserve(matches.matches.size() + 1);
  Row row(source.skeleton.bones.size());
  const auto add = [&](const Mesh& mesh, Index v, const SurfaceMatch& match) {
    const Mesh& of = source.meshes[match.mesh];
    row.add(1.0, mesh, v, target_slots[mesh.skin]);
    for (std::size_t k = 0; k < 3; ++k)
      if (match.barycentric[k] > 0)
        row.add(-match.barycentric[k], of, of.triangles[match.triangle][k], source_slots[of.skin]);
  };
  for (Index m = 0; m < target.meshes.size(); ++m)
    for (Index v = 0; v < target.meshes[m].vertex_count(); ++v) {
      if (matches.of(m, v).is_accepted) add(target.meshes[m], v, matches.of(m, v));
      row.finish(differences);
    }
  return differences;
}

}  // namespace sunder::validation
