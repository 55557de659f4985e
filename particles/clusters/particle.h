#pragma once

#include <sunder/particles/particle_set.h>

#include "particles/clusters/lip_point.h"

namespace sunder::particles {

/// The part of a rest place that one bone moves: the sum of w [v; 1] over members, with the bone's
/// weight w and the bind position v.
struct RestTerm {
  Index slot = 0;  ///< Over all skins: SurfacePose::first_slot().
  Vec4d sum = Vec4d::Zero();
};

/// The same for the displacements of a morph target.
struct RestMorphTerm {
  Index morph_weight = 0, slot = 0;
  Vec3d sum = Vec3d::Zero();
};

struct Particle {
  std::uint64_t serial = 0;
  std::uint64_t revision = 0;  ///< Structure::revision of its last change.
  Index seed = 0;
  float range = 0;
  Index member_count = 0;
  double area = 0;  ///< Of its cell: a third of each face around its points, square metres.
  std::vector<RestTerm> terms;
  std::vector<RestMorphTerm> morph_terms;
  std::vector<ParticleNeighbour> neighbours;  ///< Ascending.
  ParticleInfluences parents;
  struct OfTear {
    Index tear = 0;
    Side side = Side::left;
  };
  std::vector<OfTear> sides;  ///< Of the tears that it touches: it has no point on the other lip.

  [[nodiscard]] const Side* side_of(Index tear) const {
    for (const OfTear& of : sides)
      if (of.tear == tear) return &of.side;
    return nullptr;
  }
};

}  // namespace sunder::particles
