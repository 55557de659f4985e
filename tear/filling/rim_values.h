#pragma once

#include <span>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// The values of a cap's vertices that are extended from its rim to its inner points, as rows of
/// channels: bind position, weights of the slots, morph displacements.
class RimValues {
 public:
  /// @param vertices  those of the rim.
  RimValues(Index mesh, std::span<const Index> vertices, const SurfaceEditor& editor);

  /// Reads the rows of the rim. @param point_count  number of rows; the others are zero.
  [[nodiscard]] ScratchVector<double> rows(std::span<const Index> vertices,
                                           std::size_t point_count) const;
  [[nodiscard]] std::size_t channels() const { return 3 + slots_.size() + 3 * target_count_; }

  /// The values of one row. Valid until the next call.
  struct Vertex {
    Vec3d bind_position = Vec3d::Zero();
    std::span<const Influence> influences;  ///< Normalised, the largest first.
    std::span<const Vec3d> morph_displacements;
  };
  [[nodiscard]] Vertex vertex_of(const double* row);

  /// Whether two vertices have the same values, bit for bit.
  static bool are_same(Index mesh, Index vertex, Index other, const SurfaceEditor& editor);

 private:
  void weigh(const double* weights);

  const SurfaceEditor& editor_;
  Index mesh_;
  std::size_t target_count_;
  ScratchVector<Index> slots_;     ///< Of the bones that move the rim, ascending.
  ScratchVector<Index> place_of_;  ///< The place in slots_ of each slot up to the greatest one.
  ScratchVector<Influence> influences_;
  ScratchVector<Vec3d> displacements_;
};

}  // namespace sunder::tear
