#pragma once

#include "particles/clusters/structure.h"
#include "particles/front/marks.h"
#include "tear/internal/surface.h"

namespace sunder::particles {

/// Gradients of the weights of points along the surface. Gradients that changed since the last of()
/// are recomputed there.
class Gradients {
 public:
  /// Reserves room for `points` and some more, so that the next tears need not move the rows.
  void make_room(std::size_t points) { reserve_eighth(gradients_, points); }
  /// Begins an operation: forget() logs gradients in its change.
  void begin_change(Change& change);
  /// Invalidates points whose weights changed, and their neighbours.
  /// @param change  of the operation; null: not logged.
  void forget(const Surface& surface, std::span<const Index> points, Change* change);
  /// Invalidates the points of faces that changed.
  void forget(const TornModel& model, const Structure& structure,
              std::span<const ChangeRecord> changes, Change* change);
  /// Exchanges the gradients with those that a change logged, while it is undone or redone.
  /// @return false if it logged none.
  bool exchange(Change& change);
  /// The result of the last of().
  [[nodiscard]] std::span<const ParticleGradients> known() const { return gradients_; }
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Whether the next of() has nothing to compute, and changes nothing.
  [[nodiscard]] bool is_up_to_date(Index point_count) const {
    return is_wanted_ && unknown_.empty() && is_known_.size() == point_count &&
           gradients_.size() == point_count;
  }
  /// Whether of() was ever called. Before, nothing is computed or logged.
  [[nodiscard]] bool is_wanted() const { return is_wanted_; }
  /// Frees the rows, which are up to date or not wanted.
  void release_rows();
  /// @param fill  writes the rows as they were. @param last  the last operation, or null.
  /// @throws std::bad_alloc
  template <class Fill>
  void restore_rows(Fill fill, const Change* last) {
    fill(gradients_);
    if (!is_wanted_) return;
    reserve_eighth(unknown_, gradients_.size());
    logged_.begin(gradients_.size());
    if (last == nullptr || !last->changed_gradients) return;
    for (const Change::OfGradients& of : *last->changed_gradients)
      if (of.point < last->points) (void)logged_.mark(of.point);
  }
  /// One entry per point.
  std::span<const ParticleGradients> of(const Surface& surface, const Structure& structure);

 private:
  void forget(Index point, Change* change);
  void forget(const TornModel& model, const Structure& structure, const MeshChange& of_mesh,
              Change* change);

  std::vector<ParticleGradients> gradients_;
  std::vector<bool> is_known_;
  std::vector<Index> unknown_;  ///< Has room for all points of `is_known_`.
  Marks logged_;                ///< Points that the current change has logged.
  bool is_wanted_ = false;
};

}  // namespace sunder::particles
