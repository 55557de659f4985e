#pragma once

#include <sunder/particles/particle_set.h>

#include <map>
#include <memory>
#include <utility>

#include "particles/clusters/posed_points.h"
#include "particles/clusters/repair_scratch.h"
#include "particles/front/surface_front.h"

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

/// Which side of a tear something is on.
enum class Side : std::uint8_t { left, right };

struct Particle {
  std::uint64_t serial = 0;
  Index seed = 0;
  float range = 0;
  Index member_count = 0;
  double weight = 0;  ///< Sum of what influences give it.
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

/// That a point is on a lip of a tear.
struct OnLip {
  Index tear = kNone;
  Side side = Side::left;
  Index older = kNone;  ///< The tear before that whose lip it is on as well, in Structure::older_lips.
};

/// The newest lip that a point is on, if any, and where the edge of a lip that leaves it is kept.
struct LipPoint : OnLip {
  Index edge = kNone;  ///< In Structure::lips.
};

/// What one operation did to the structure, to take it back: values as they were. Exchanging them with those that are takes it
/// back, or does it again.
struct Change {
  std::uint64_t operation = 0;                ///< TornModel::newest_operation() of its end; 0: under way.
  Index points = 0, particles = 0, lips = 0;  ///< How many there were.
  std::size_t memberships_before = 0, memberships_after = 0;
  std::vector<Index> vertices;  ///< Of each mesh, how many there were.

  struct OfPoint;
  struct OfVertex {
    Index mesh = 0, vertex = 0, point = kNone;
  };
  std::vector<OfPoint> changed_points;
  std::vector<std::pair<Index, Particle>> changed_particles;
  std::vector<OfVertex> changed_vertices;
  std::vector<std::pair<Index, LipEdge>> changed_lips;

  /// What it appended, while it is taken back.
  struct Appended;
  std::shared_ptr<Appended> appended;
};

struct Band;
/// Where a point of a band lies: beside which place of which chain.
struct BesideLip {
  Index chain = 0, place = 0;
};
class Gradients;
class PairChanges;

/// What a ParticleSet is made of.
struct Structure {
  Structure();
  ~Structure();

  DecompositionReport report;
  std::uint64_t revision = 0;
  std::uint64_t next_serial = 1;
  std::vector<Index> dirty;  ///< Points whose influences the last call changed, in no order.

  // ---- Of the model.
  const Character* source = nullptr;  ///< Only to be compared.
  std::vector<Skin> skins;
  std::vector<Index> first_slot;  ///< Of each skin; at the end their number.
  std::size_t bone_count = 0, morph_weight_count = 0;
  PosedPoints posed_points;  ///< In the decomposition's pose.
  std::vector<std::vector<Index>> vertex_points;
  /// Vertices in which a surface touches itself have several points: all that they ever had.
  std::map<std::pair<Index, Index>, std::vector<Index>> shared_vertices;

  // ---- Points.
  std::vector<Vec3f> positions;  ///< In that pose.
  /// A vertex of each, whose weights those of its others are: the one that it had when it came.
  std::vector<VertexRef> vertices;
  float edge_length = 0;  ///< In the mean, of the decomposition's surface.
  /// A point's memberships lie together in `memberships`, ascending by particle. A change puts the new ones at the end and leaves
  /// the old where they are, for undo.
  struct Slab {
    Index first = 0, count = 0;
  };
  std::vector<Slab> slabs;
  std::vector<ParticleMembership> memberships;
  std::vector<ParticleInfluences> influences;
  std::vector<LipPoint> lip_points;
  std::vector<OnLip> older_lips;  ///< Grows only: what undo takes back, redo may need again.

  // ---- Particles.
  std::vector<Particle> particles;
  /// Members as the decomposition found them, particle after particle, and those that joined later; some have left since.
  std::vector<Index> first_member, members;
  std::vector<std::vector<Index>> joined;

  // ---- Tears. A tear is an operation: the place of its Change is its number.
  std::vector<LipEdge> lips;
  std::vector<Change> done, undone;
  std::unique_ptr<Band> band;       ///< What the last one left to settle().
  std::size_t memberships_end = 0;  ///< Of those that are in use: changes that were taken back have theirs behind.
  Index triangle_count = 0;         ///< Of the surface when it was followed last.
  bool is_broken = false;           ///< Memory ran out half way.

  // ---- Memory that is used again.
  SurfaceFront front, band_front;
  std::vector<BesideLip> beside;  ///< Of the points that band_front has reached. One a point.
  RepairScratch scratch;
  std::unique_ptr<PairChanges> pairs;
  std::unique_ptr<Gradients> gradients;
  mutable std::vector<Affine3d> palette;  ///< Of all slots: what rest() computes with.

  void share_vertex(Index mesh, Index vertex, Index point, Index other);

  /// Memory for the first tears, so that none of them pays for all points.
  void prepare_for_tears(Index triangles);
  /// Makes room for points that came; by an eighth at a time.
  void make_room(std::size_t points);

  [[nodiscard]] Index point_count() const { return static_cast<Index>(positions.size()); }
  [[nodiscard]] std::span<const ParticleMembership> memberships_of(Index point) const {
    return {memberships.data() + slabs[point].first, slabs[point].count};
  }
  /// Calls visit(tear, side) for each lip that a point is on, the newest first.
  template <class Visit>
  void for_each_lip(Index point, Visit visit) const {
    for (const OnLip* lip = &lip_points[point]; lip->tear != kNone; lip = &older_lips[lip->older]) {
      visit(lip->tear, lip->side);
      if (lip->older == kNone) return;
    }
  }
  [[nodiscard]] bool is_on_lip(Index point, Index tear, Side side) const {
    bool is = false;
    for_each_lip(point, [&](Index of, Side on) { is |= of == tear && on == side; });
    return is;
  }
  /// Puts a point on a lip; on those of other tears it stays. Of two tears the later has the higher number.
  void put_on_lip(Index point, Index tear, Side side);
  /// Ascending.
  [[nodiscard]] std::vector<Index> members_of(Index particle) const;
  [[nodiscard]] const ParticleMembership* find(Index point, Index particle) const {
    for (const ParticleMembership& membership : memberships_of(point))
      if (membership.particle == particle) return &membership;
    return nullptr;
  }
};

struct Change::OfPoint {
  Index point = 0;
  Structure::Slab slab;
  ParticleInfluences influences;
  LipPoint lip;
};

struct Change::Appended {
  std::vector<Vec3f> positions;
  std::vector<VertexRef> vertices;
  std::vector<Structure::Slab> slabs;
  std::vector<ParticleInfluences> influences;
  std::vector<LipPoint> lip_points;
  std::vector<Particle> particles;
  std::vector<std::vector<Index>> joined;
  std::vector<LipEdge> lips;
  std::vector<std::vector<Index>> vertex_points;  ///< Of each mesh.
};

/// Takes a change back, or does it again.
void exchange(Structure& structure, Change& change);

/// A particle's share before those of one point are made to sum to one: (1 - reach^2)^2, which ends with slope zero.
[[nodiscard]] inline float falloff(float reach) {
  const float rest = 1 - reach * reach;
  return rest * rest;
}

/// Where the two lips of a tear meet, ascending.
[[nodiscard]] std::vector<Index> find_tips(const TornModel& model, const Structure& structure);

/// Influences from memberships: the four largest shares, less the fifth, so that nothing jumps where another becomes the fourth.
[[nodiscard]] ParticleInfluences influences_from(std::span<const ParticleMembership> memberships);

}  // namespace sunder::particles
