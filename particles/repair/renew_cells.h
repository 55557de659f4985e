#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// The triangles to which an operation gave other points, with those that they had before,
/// ascending.
struct RewrittenFaces {
  struct Face {
    Index triangle = 0;
    std::array<Index, 3> points = {};
  };
  std::vector<Face> faces;
  /// Whether one of their vertices is at several points, so that `points` may be others than those
  /// of the face.
  bool is_ambiguous = false;
};

/// Must be called before the points of vertices are renewed.
[[nodiscard]] RewrittenFaces find_rewritten_faces(const TornModel& model,
                                                  const Structure& structure,
                                                  std::span<const ChangeRecord> changes);

/// Brings areas, neighbours and couplings of particles up to date: for faces that an operation
/// changed, and for those around points that went over to another cell. O(these faces).
void renew_cells(StructureEdit& edit, const RewrittenFaces& rewritten);

}  // namespace sunder::particles
