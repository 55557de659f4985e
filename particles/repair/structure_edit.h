#pragma once

#include "particles/clusters/lip_border.h"
#include "particles/clusters/structure.h"

namespace sunder::particles {

struct RewrittenFaces;

/// One call's changes to a structure. Memberships of changing points are kept separately and
/// written back together, so that each point is removed from the sums of its particles and added to
/// others once. All changes are logged in a Change, for undo.
class StructureEdit {
 public:
  ///
  /// @param tear  index of the current operation.
  StructureEdit(const TornModel& model, Structure& structure, Change& change, Index tear);

  [[nodiscard]] const TornModel& model() const { return model_; }
  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] const LipBorder& border() const { return border_; }
  [[nodiscard]] Structure& structure() const { return structure_; }
  [[nodiscard]] Change& change() const { return change_; }
  [[nodiscard]] Index tear() const { return tear_; }
  /// Points from this index on were created by this call.
  [[nodiscard]] Index first_new_point() const { return first_new_point_; }
  /// The cell in which a point was before the edit; kNone for a new one.
  [[nodiscard]] Index owner_before(Index point) const;
  /// Particles whose seed the edit moved.
  [[nodiscard]] std::span<const Index> moved_seeds() const { return moved_seeds_; }
  /// Memory for neighbours of points, and a second one for use while the first is in use.
  [[nodiscard]] RingWalk& ring() { return ring_; }
  [[nodiscard]] RingWalk& other_ring() { return other_ring_; }

  // ---- Points.

  /// The memberships of a point in this edit. Valid until the next change.
  [[nodiscard]] std::span<const ParticleMembership> memberships(Index point) const;
  /// Adds a point to the edit, so that finish() updates it.
  void take_up(Index point) { (void)work_of(point); }
  [[nodiscard]] std::size_t taken_up_count() const { return arrays_.works.size(); }
  [[nodiscard]] Index taken_up(std::size_t i) const { return arrays_.works[i].point; }

  /// Adds a membership; of two of the same particle the nearer is kept.
  void join(Index point, const ParticleMembership& membership);
  /// Removes all memberships.
  void leave_all(Index point) { work_of(point).count = 0; }
  /// Calls keep(membership), which may change it, and removes those for which it returns false.
  template <class Keep>
  void keep_if(Index point, Keep keep) {
    Work& work = work_of(point);
    Index kept = 0;
    for (Index i = 0; i < work.count; ++i) {
      ParticleMembership membership = arrays_.memberships[work.first + i];
      if (keep(membership)) arrays_.memberships[work.first + kept++] = membership;
    }
    work.count = kept;
  }
  /// Whether the lips of a point let it belong to a particle. A particle without a side of a tear
  /// gets that of the point.
  /// @param undecided_tear  whose sides choose_sides() decides later.
  [[nodiscard]] bool may_join(Index point, Index particle, Index undecided_tear = kNone);
  /// Logs a point before its lips or influences change.
  void log_point(Index point);

  // ---- Particles.

  /// @return its index.
  Index make_particle(Index seed, float range, const ParticleInfluences& parents);
  /// Logs a particle before it changes. The reference is valid until the next make_particle().
  Particle& change_particle(Index particle);
  void move_seed(Index particle, Index seed);

  /// Ends the call: writes all changes to the structure.
  /// @param rewritten  by the operation that the call follows.
  void finish(const RewrittenFaces& rewritten);

 private:
  using Work = EditArrays::Work;
  using Counted = EditArrays::Counted;

  Work& work_of(Index point);
  void put_back(const Work& work);
  void write_memberships(Index point, std::span<const ParticleMembership> now);
  void count_members(Index point, std::span<const ParticleMembership> before,
                     std::span<const ParticleMembership> now);
  void sum_rests();

  const TornModel& model_;
  const Surface& surface_;
  Structure& structure_;
  Change& change_;
  Index tear_;
  Index first_new_point_;
  LipBorder border_;
  RingWalk ring_, other_ring_;
  EditArrays arrays_;
  std::vector<Index> moved_seeds_;
};

}  // namespace sunder::particles
