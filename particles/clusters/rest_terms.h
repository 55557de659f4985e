#pragma once

#include "particles/clusters/particle.h"
#include "particles/clusters/point_table.h"

namespace sunder::particles {

/// One vertex of a point, because all of them are posed alike. None for a point without a face.
[[nodiscard]] VertexRef vertex_of(const TornModel& model, Index point);

/// Calls visit(slot, w [v; 1]) for each bone that moves a vertex, and visit_morph(morph weight,
/// slot, w delta) for each morph target and bone, as in skinning. Points of the policy `exact` have
/// a position per influence in place of w v.
/// @param first_slot  per skin: SurfacePose::first_slots().
template <class Visit, class VisitMorph>
void for_each_rest_term(const TornModel& model, std::span<const Index> first_slot,
                        const VertexRef& of, Visit visit, VisitMorph visit_morph) {
  const Mesh& mesh = model.character().meshes[of.mesh];
  const Index first = first_slot[mesh.skin];
  const std::span<const Influence> influences = mesh.weights.of(of.vertex);
  const Index place = model.influence_place(of.mesh, of.vertex);
  const InfluencePositions* exact = place == kNone ? nullptr : &model.influence_positions(of.mesh);
  for (std::size_t i = 0; i < influences.size(); ++i) {
    const double weight = influences[i].weight;
    const Vec3f& at = exact != nullptr ? exact->positions[place + i] : mesh.positions[of.vertex];
    const double part = exact != nullptr ? 1.0 : weight;
    visit(first + influences[i].slot,
          Vec4d(part * double{at.x()}, part * double{at.y()}, part * double{at.z()}, weight));
  }
  for (Index t = 0; t < mesh.morph_targets.size(); ++t) {
    if (exact != nullptr && !exact->morph_targets.empty() &&
        !exact->morph_targets[t].positions.empty()) {
      for (std::size_t i = 0; i < influences.size(); ++i)
        visit_morph(mesh.first_morph_weight + t, first + influences[i].slot,
                    Vec3d(exact->morph_targets[t].positions[place + i].cast<double>()));
      continue;
    }
    const auto& deltas = mesh.morph_targets[t].position_deltas;
    if (deltas.empty() || deltas[of.vertex] == Vec3f::Zero()) continue;
    for (const Influence& influence : influences)
      visit_morph(mesh.first_morph_weight + t, first + influence.slot,
                  Vec3d(influence.weight * deltas[of.vertex].cast<double>()));
  }
}

/// Adds the terms of vertices to particles or subtracts them, all vertices of a particle together:
/// vertices of a cap may have a hundred influences, whose places in the particle are looked up
/// once.
class RestChange {
 public:
  RestChange(const TornModel& model, std::span<const Index> first_slot)
      : model_(model), first_slot_(first_slot) {}

  /// Begins with a particle, which must not move before finish().
  void begin(Particle& particle);
  /// @param sign  1 or -1.
  void add(const VertexRef& vertex, double sign);
  void finish();

 private:
  const TornModel& model_;
  std::span<const Index> first_slot_;
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
  struct OfMesh {
    const Mesh* mesh;
    Index first_slot;
    bool is_plain;  ///< The mesh has neither morph targets nor exact points.
  };
  struct OfSlot {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    bool is_listed = false;
  };

  const TornModel& model_;
  std::span<const Index> first_slot_;
  std::span<const VertexRef> vertices_;
  std::vector<OfMesh> meshes_;
  std::vector<OfSlot> of_slot_;  ///< All zero between calls.
  std::vector<Index> slots_;     ///< Those listed.
};

}  // namespace sunder::particles
