#include "validation/checks/skin_points.h"

#include <sunder/skinning/pose.h>

#include <algorithm>

#include "core/internal/or_throw.h"

namespace sunder::validation {

void TermSum::finish(SkinDifferences& points) {
  std::sort(used_.begin(), used_.end());
  for (const Index bone : used_) {
    if (!sums_[bone].isZero(0))
      points.terms.push_back({bone, sums_[bone][3], sums_[bone].head<3>()});
    sums_[bone].setZero();
  }
  used_.clear();
  points.first.push_back(static_cast<Index>(points.terms.size()));
}

SkinPoints::SkinPoints(const RowReader& reader)
    : reader_(reader), bind_(or_throw(bind_pose(reader.source().character))) {
  const Character &source = reader.source().character, &target = reader.target().character;
  const auto palettes = bind_palettes(source, bind_);
  for (std::size_t skin = 0; skin < source.skins.size(); ++skin) {
    auto& slots = of_source_.emplace_back();
    for (std::size_t i = 0; i < source.skins[skin].bones.size(); ++i)
      slots.push_back({source.skins[skin].bones[i], palettes[skin][i]});
  }
  const ModelPose own = or_throw(bind_pose(target));
  for (const Skin& skin : target.skins) {
    auto& slots = of_target_.emplace_back();
    for (std::size_t i = 0; i < skin.bones.size(); ++i) {
      const Index counterpart = reader.bones().source_of_target[skin.bones[i]];
      const Affine3d& model_from_bone = counterpart != kNone ? bind_.model_from_bone[counterpart]
                                                             : own.model_from_bone[skin.bones[i]];
      slots.push_back({reader.bones().driver_of_target[skin.bones[i]],
                       multiply(model_from_bone, Affine3d(skin.bone_from_bind[i].cast<double>()))});
    }
  }
}

void SkinPoints::add_target(Index mesh, Index vertex, double part, TermSum& sum) const {
  add_influences(mesh, vertex, reader_.target().influences(mesh, vertex), part, sum);
}

void SkinPoints::add_influences(Index mesh, Index vertex, std::span<const Influence> influences,
                                double part, TermSum& sum) const {
  const Mesh& of = reader_.target().character.meshes[mesh];
  const Vec3d position = of.positions[vertex].cast<double>();
  for (const Influence& influence : influences) {
    const Slot& slot = of_target_[of.skin][influence.slot];
    const double m = part * static_cast<double>(influence.weight);
    sum.add(slot.bone, m, m * transform(slot.model_from_bind, position));
  }
}

void SkinPoints::add_expected(Index mesh, Index vertex, double part, TermSum& sum) const {
  const Skinned &source = reader_.source(), &target = reader_.target();
  const SurfaceMatch& match = reader_.match(mesh, vertex);
  const Mesh& of = source.character.meshes[match.mesh];
  const Triangle& corners = of.triangles[match.triangle];
  Vec3d in_bind = Vec3d::Zero(), in_model = Vec3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    in_bind += match.barycentric[k] * of.positions[corners[k]].cast<double>();
    in_model += match.barycentric[k] *
                source.surface.positions[source.surface.first_vertex[match.mesh] + corners[k]];
  }
  const Vec3d offset =
      target.surface.positions[target.surface.first_vertex[mesh] + vertex] - in_model;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(match.barycentric[k] > 0)) continue;
    for (const Influence& influence : of.weights.of(corners[k])) {
      const Slot& slot = of_source_[of.skin][influence.slot];
      const double m = part * match.barycentric[k] * static_cast<double>(influence.weight);
      const Vec3d place = transform(slot.model_from_bind, in_bind) + offset;
      sum.add(slot.bone, m, m * place);
    }
  }
}

}  // namespace sunder::validation
