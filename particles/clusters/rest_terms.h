#pragma once

#include "particles/clusters/particle.h"
#include "particles/clusters/point_table.h"
#include "tear/internal/former_weights.h"

namespace sunder::particles {

/// One vertex of a point, because all of them are posed alike. None for a point without a face.
[[nodiscard]] VertexRef vertex_of(const TornModel& model, Index point);

/// The terms of a mesh's vertices in the rests of particles.
class MeshRestTerms {
 public:
  ///
  /// @param first_slot  per skin: SurfacePose::first_slots().
  MeshRestTerms(const TornModel& model, std::span<const Index> first_slot, Index mesh)
      : model_(model),
        index_(mesh),
        mesh_(model.character().meshes[mesh]),
        first_slot_(first_slot[mesh_.skin]),
        exact_(model.influence_positions(mesh)),
        is_plain_(mesh_.morph_targets.empty() && exact_.vertices.empty()) {}

  /// Calls visit(slot, w [v; 1]) for each bone that moves a vertex, and visit_morph(morph weight,
  /// slot, w delta) for each morph target and bone, as in skinning. Points of the policy `exact`
  /// have a position per influence in place of w v.
  template <class Visit, class VisitMorph>
  void for_each(Index vertex, Visit visit, VisitMorph visit_morph) const {
    const std::span<const Influence> influences = mesh_.weights.of(vertex);
    const Index place = is_plain_ ? kNone : model_.influence_place(index_, vertex);
    if (place == kNone) {
      for_each_of(vertex, mesh_.positions[vertex], influences, visit, visit_morph);
      return;
    }
    for (std::size_t i = 0; i < influences.size(); ++i) {
      const Vec3f& at = exact_.positions[place + i];
      visit(first_slot_ + influences[i].slot,
            Vec4d(double{at.x()}, double{at.y()}, double{at.z()}, double{influences[i].weight}));
    }
    for (Index t = 0; t < mesh_.morph_targets.size(); ++t) {
      if (exact_.morph_targets.empty() || exact_.morph_targets[t].positions.empty()) {
        visit_deltas(t, vertex, influences, visit_morph);
        continue;
      }
      for (std::size_t i = 0; i < influences.size(); ++i)
        visit_morph(mesh_.first_morph_weight + t, first_slot_ + influences[i].slot,
                    Vec3d(exact_.morph_targets[t].positions[place + i].cast<double>()));
    }
  }
  /// The same for a vertex with another bind position and other influences, not of the policy
  /// `exact`.
  template <class Visit, class VisitMorph>
  void for_each_of(Index vertex, const Vec3f& at, std::span<const Influence> influences,
                   Visit visit, VisitMorph visit_morph) const {
    const Vec4d one(double{at.x()}, double{at.y()}, double{at.z()}, 1.0);
    for (const Influence& influence : influences)
      visit(first_slot_ + influence.slot, Vec4d(double{influence.weight} * one));
    for (Index t = 0; t < mesh_.morph_targets.size(); ++t)
      visit_deltas(t, vertex, influences, visit_morph);
  }

 private:
  template <class VisitMorph>
  void visit_deltas(Index target, Index vertex, std::span<const Influence> influences,
                    VisitMorph visit_morph) const {
    const auto& deltas = mesh_.morph_targets[target].position_deltas;
    if (deltas.empty() || deltas[vertex] == Vec3f::Zero()) return;
    for (const Influence& influence : influences)
      visit_morph(mesh_.first_morph_weight + target, first_slot_ + influence.slot,
                  Vec3d(influence.weight * deltas[vertex].cast<double>()));
  }

  const TornModel& model_;
  Index index_;
  const Mesh& mesh_;
  Index first_slot_;
  const InfluencePositions& exact_;
  bool is_plain_;  ///< The mesh has neither morph targets nor exact points.
};

/// Those of all meshes. @param first_slot  as of MeshRestTerms.
[[nodiscard]] std::vector<MeshRestTerms> rest_terms_of(const TornModel& model,
                                                       std::span<const Index> first_slot);

/// Adds the terms of vertices to particles or subtracts them, all vertices of a particle together:
/// vertices of a cap may have a hundred influences, whose places in the particle are looked up
/// once.
class RestChange {
 public:
  RestChange(const TornModel& model, std::span<const Index> first_slot)
      : meshes_(rest_terms_of(model, first_slot)), places_(first_slot.back(), kNone) {}

  /// Begins with a particle, which must not move before finish().
  void begin(Particle& particle);
  /// @param sign  1 or -1.
  void add(const VertexRef& vertex, double sign);
  /// Replaces the terms that a vertex had before by those that it has now.
  void replace(const tear::FormerWeights& before);
  void finish();

 private:
  void add_term(Index slot, const Vec4d& term);

  std::vector<MeshRestTerms> meshes_;
  Particle* particle_ = nullptr;
  std::vector<Index> places_;  ///< Per slot: its place in the particle's terms, or kNone.
};

/// Sums the terms of particles' members.
class RestSums {
 public:
  /// @param vertices  per point. All arguments must outlive this.
  RestSums(const TornModel& model, std::span<const Index> first_slot,
           std::span<const VertexRef> vertices);

  /// Recomputes the terms of a particle. O(members x influences).
  void sum(std::span<const Index> members, Particle& particle);

 private:
  struct OfSlot {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    bool is_listed = false;
  };

  std::vector<MeshRestTerms> meshes_;
  std::span<const VertexRef> vertices_;
  std::vector<OfSlot> of_slot_;  ///< All zero between calls.
  std::vector<Index> slots_;     ///< Those listed.
};

}  // namespace sunder::particles
