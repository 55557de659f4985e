#include "pipeline/validation/checks/skin_points.h"

#include "core/internal/ordered.h"

namespace sunder::validation {

SkinPoints::SkinPoints(const RowReader& reader)
    : reader_(reader),
      skins_(make_driven_skins(reader.source().character, reader.target().character,
                               reader.bones())) {}

void SkinPoints::add_target(Index mesh, Index vertex, double part, TermSum& sum) const {
  add_influences(mesh, vertex, reader_.target().influences(mesh, vertex), part, sum);
}

void SkinPoints::add_influences(Index mesh, Index vertex, std::span<const Influence> influences,
                                double part, TermSum& sum) const {
  const Mesh& of = reader_.target().character.meshes[mesh];
  sum.add_point(of.positions[vertex].cast<double>(), influences, skins_.of_target[of.skin], part);
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
      const DrivenSlot& slot = skins_.of_source[of.skin][influence.slot];
      const double m = part * match.barycentric[k] * static_cast<double>(influence.weight);
      const Vec3d place = transform(slot.model_from_bind, in_bind) + offset;
      sum.add(slot.bone, m, m * place);
    }
  }
}

}  // namespace sunder::validation
