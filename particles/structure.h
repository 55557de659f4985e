#pragma once

#include <sunder/particles/particle_set.h>

#include "particles/surface_front.h"

namespace sunder::particles {

/// A vertex of a mesh.
struct VertexRef {
  Index mesh = 0, vertex = kNone;
};

/// A sum over a particle's members of what a bone moves: w_vi [v; 1].
struct RestTerm {
  Index slot = 0;  ///< Over all skins: Structure::first_slot.
  Vec4d sum = Vec4d::Zero();
};

/// The same of a morph target's displacements.
struct RestMorphTerm {
  Index morph_weight = 0, slot = 0;
  Vec3d sum = Vec3d::Zero();
};

struct Particle {
  std::uint64_t serial = 0;
  Index seed = 0;
  float range = 0;
  Index member_count = 0;
  double weight = 0;  ///< Sum of what influences give it.
  std::vector<RestTerm> terms;
  std::vector<RestMorphTerm> morph_terms;
  std::vector<Neighbour> neighbours;  ///< Ascending.
  ParticleInfluences parents;
};

/// What a ParticleSet is made of.
struct Structure {
  DecompositionReport report;
  std::uint64_t revision = 0;
  std::uint64_t next_serial = 1;
  DirtyRanges dirty_points;

  // ---- Of the model.
  std::vector<Skin> skins;
  std::vector<Index> first_slot;  ///< Of each skin; at the end their number.
  std::size_t bone_count = 0, morph_weight_count = 0;
  ModelPose pose;                               ///< Of the decomposition.
  std::vector<std::vector<Affine3d>> palettes;  ///< In it.
  std::vector<std::vector<Index>> vertex_points;

  // ---- Points.
  /// A vertex of each, whose weights those of its others are: the one that it had when it came.
  std::vector<VertexRef> vertices;
  float edge_length = 0;         ///< In the mean, of the decomposition's surface.
  std::vector<Vec3f> positions;  ///< In that pose.
  /// A point's memberships lie together in `memberships`, ascending by particle. A change puts the new ones at the end and leaves
  /// the old where they are, for undo.
  struct Slab {
    Index first = 0, count = 0;
  };
  std::vector<Slab> slabs;
  std::vector<Membership> memberships;
  std::vector<ParticleInfluences> influences;

  // ---- Particles.
  std::vector<Particle> particles;
  /// Members as the decomposition found them, particle after particle, and those that joined later; some have left since.
  std::vector<Index> first_member, members;
  std::vector<std::vector<Index>> joined;

  std::vector<LipEdge> lips;

  SurfaceFront front;
  mutable std::vector<Affine3d> palette;  ///< Of all slots: what rest() computes with.

  [[nodiscard]] Index point_count() const { return static_cast<Index>(positions.size()); }
  [[nodiscard]] std::span<const Membership> memberships_of(Index point) const {
    return {memberships.data() + slabs[point].first, slabs[point].count};
  }
  /// Ascending.
  [[nodiscard]] std::vector<Index> members_of(Index particle) const;
  [[nodiscard]] const Membership* find(Index point, Index particle) const {
    for (const Membership& membership : memberships_of(point))
      if (membership.particle == particle) return &membership;
    return nullptr;
  }
};

/// A particle's share before those of one point are made to sum to one: (1 - reach^2)^2, which ends with slope zero.
[[nodiscard]] inline float falloff(float reach) {
  const float rest = 1 - reach * reach;
  return rest * rest;
}

/// Influences from memberships: the four largest shares, less the fifth, so that nothing jumps where another becomes the fourth.
[[nodiscard]] ParticleInfluences influences_from(std::span<const Membership> memberships);

}  // namespace sunder::particles
