#pragma once

#include "particles/clusters/band.h"
#include "particles/clusters/lip_border.h"
#include "particles/clusters/rest_terms.h"
#include "tear/internal/surface.h"

namespace sunder::particles {

/// Brings a structure up to date with what was done to its model. Points that change are worked on beside the structure and put
/// back together, so that each is counted out of its particles and into others once.
class Repair {
 public:
  Repair(const TornModel& model, Structure& structure, Change& change, Index tear);

  /// Takes up new points, new lips, and weights that are other than they were.
  void follow(std::span<const ChangeRecord> changes);
  /// Goes on with the band beside the lips for at most so many points.
  void widen(Index points);
  /// Ends a call: what changed is put back.
  void finish();

 private:
  /// A point that changes: its memberships as they are to be.
  struct Work {
    Index point = 0;
    Index first = 0, count = 0, room = 0;  ///< In memberships_.
  };

  // ---- Points and particles that change (repair_works.cpp).
  [[nodiscard]] Work& work_of(Index point);
  [[nodiscard]] std::span<ParticleMembership> memberships(const Work& work) {
    return {memberships_.data() + work.first, work.count};
  }
  /// Memberships as they stand, worked on or not.
  [[nodiscard]] std::span<const ParticleMembership> current(Index point);
  void join(Index point, const ParticleMembership& membership);
  /// Whether the lips let a point belong to a particle; one that had no side yet gets the point's, but where choose_sides() is to
  /// say.
  [[nodiscard]] bool may_join(Index point, Index particle);
  Index make_particle(Index seed, float range, const ParticleInfluences& parents);
  Particle& change_particle(Index particle);
  void log_point(Index point);
  void put_back(const Work& work);

  // ---- What an operation left (repair.cpp).
  void append_points();
  void renew_vertex_points(std::span<const ChangeRecord> changes);
  void set_vertex_point(Index mesh, Index vertex, Index point);
  [[nodiscard]] bool has_vertex(Index point, Index mesh, Index vertex) const;
  void lose(Index point);
  void leave_lost_points(std::span<const ChangeRecord> changes);
  void take_up_lips(std::span<const ChangeRecord> changes);
  void take_up_older_lips();
  void spread_to_new_points();
  bool spread_to(Index point);
  void renew_weights(std::span<const ChangeRecord> changes);
  /// Makes a particle where a point has none left near enough: at once, so that what comes of it does not depend on where a call
  /// of settle() ends.
  void cover(Index seed);
  [[nodiscard]] ParticleInfluences influences_before(Index point);
  void cover();

  // ---- Lips (repair_lips.cpp).
  void choose_sides();
  void begin_band();
  void visit_band(Index point, float distance, Index from);
  void make_lip_particles(LipChain& chain);
  void keep_to_own_side(Index point, const LipChain& chain, const LipChain::Place& place, float distance);
  void join_lip_particles(Index point, const LipChain& chain, const LipChain::Place& place, float distance);
  void renew_lip_edges();
  void keep_edge(Index half_edge);
  void forget_edge(Index point);
  void begin_hole();
  void widen_band(Index points);
  void queue_beside_lips(Band& band);
  Index grow(Index particle);

  const TornModel& model_;
  const Surface& surface_;
  Structure& structure_;
  Change& change_;
  Index tear_;
  Index first_new_;  ///< Points from here up came with this call.
  LipBorder border_;

  std::vector<Work> works_;
  std::vector<ParticleMembership> memberships_;
  RestOfVertex rest_;
  RingWalk ring_, other_ring_;    ///< The second for what is begun while the first is in use.
  std::vector<Index> lips_;       ///< Points that this call put on lips.
  std::vector<Index> left_;       ///< Points that left a particle which was grown anew.
  std::vector<Index> lost_;       ///< Points that it left without a face.
  bool is_before_sides_ = false;  ///< choose_sides() is still to come.
};

/// Follows an operation, or an extension of the one under way.
void follow_operation(const TornModel& model, Structure& structure, std::span<const ChangeRecord> changes);
/// Goes on with the band that the last one left, for at most so many points, or to its end.
void widen_band(const TornModel& model, Structure& structure, Index points);
void complete_band(const TornModel& model, Structure& structure);

}  // namespace sunder::particles
