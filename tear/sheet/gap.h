#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "tear/path/across_crack.h"
#include "tear/sheet/cell_sides.h"
#include "tear/surface/sort_by_index.h"

namespace sunder::tear {

/// The live faces of which a part lies inside a cell, ascending.
[[nodiscard]] ScratchVector<CellFace> faces_in_cell(CellSides& sides);
/// The same. `may_hold_any(box)` excludes more boxes of the frame, or is cheaper, than the
/// half-spaces of the cell.
template <class MayHoldAny>
[[nodiscard]] ScratchVector<CellFace> faces_in_cell(CellSides& sides, const Frame& frame,
                                                    MayHoldAny may_hold_any);

/// Whether more than a border of a face lies in the cell. Tells the face whether all of it does.
[[nodiscard]] bool is_face_in_cell(CellFace& face, CellSides& sides);
/// Whether a part of edge k of a face lies in the cell.
[[nodiscard]] bool is_edge_in_cell(const CellFace& face, Index k, CellSides& sides);

/// The faces of which a part lies inside a cell and that are connected to the seeds inside it,
/// ascending. The search goes on across cracks of the source.
/// @param widest_crack  whose sides are farther apart is a border.
/// @param is_wanted  is_wanted(cell face): whether the search may enter a face.
template <class IsWanted>
[[nodiscard]] ScratchVector<CellFace> faces_in_cell(CellSides& sides, std::span<const Index> seeds,
                                                    double widest_crack, IsWanted is_wanted);

/// Figures of the removal of a cell.
struct GapRemoval {
  Index faces_crossed = 0;
  Index faces_removed = 0;
  Index blocked = 0;
  double area_posed = 0;
};

/// The border that the removal of a cell left.
struct CellRim {
  explicit CellRim(ScratchMemory& memory) : edges(&memory), areas(&memory) {}

  struct Edge {
    std::array<Index, 2> points = {};
    /// The half-space of the cell on whose plane the edge lies; kNone for an edge inside the cell.
    Index side = kNone;
    Index part = 0;
  };
  ScratchVector<Edge> edges;
  /// Per removed part (faces connected by edges): the sum of the posed area vectors of its faces.
  ScratchVector<Vec3d> areas;
};

/// Removes the part of some faces that lies inside a convex cell. Faces inside are removed; faces
/// that reach out of the cell are clipped. Allocates scratch memory only.
/// @param faces  ascending.
/// @param rim  optional; written.
GapRemoval remove_cell(CellSides& sides, std::span<const CellFace> faces, SurfaceEditor& editor,
                       CellRim* rim = nullptr);

inline void sort_faces(ScratchVector<CellFace>& faces, ScratchMemory& memory) {
  sort_by_index(
      faces, [](const CellFace& face) { return face.face; }, memory);
}

template <class MayHoldAny>
ScratchVector<CellFace> faces_in_cell(CellSides& sides, const Frame& frame,
                                      MayHoldAny may_hold_any) {
  ScratchVector<CellFace> faces(&sides.memory());
  sides.posed().for_each_face(sides.editor(), frame, may_hold_any, [&](Index face) {
    CellFace found{face, sides.places_of(face)};
    if (is_face_in_cell(found, sides)) faces.push_back(found);
  });
  sort_faces(faces, sides.memory());
  return faces;
}

template <class IsWanted>
ScratchVector<CellFace> faces_in_cell(CellSides& sides, std::span<const Index> seeds,
                                      double widest_crack, IsWanted is_wanted) {
  const Surface& surface = sides.editor().surface();
  ScratchVector<CellFace> faces(&sides.memory());
  faces.reserve(4 * seeds.size());
  IndexMap seen(4 * seeds.size(), sides.memory());
  const auto visit = [&](const CellFace& face) {
    if (is_wanted(face)) faces.push_back(face);
  };
  for (const Index seed : seeds) {
    if (surface.has_repeated_point(seed)) continue;
    CellFace face{seed, sides.places_of(seed)};
    if (is_face_in_cell(face, sides) && seen.insert(seed, 0) == kNone) visit(face);
  }
  const auto cross_crack = [&](const CellFace& from, Index k) {
    if (surface.cracks.empty() || !is_edge_in_cell(from, k, sides)) return;
    for (const Index beyond :
         half_edges_across_crack(3 * from.face + k, widest_crack, sides.editor(), sides.posed())) {
      if (seen.find(beyond / 3) != kNone) continue;
      CellFace face{beyond / 3, sides.places_of(beyond / 3)};
      face.is_inside = sides.is_surely_inside(sides.at(face.places));
      if (!is_edge_in_cell(face, beyond % 3, sides)) continue;
      seen.insert(face.face, 0);
      visit(face);
    }
  };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const CellFace face = faces[i];
    for (Index k = 0; k < 3; ++k) {
      const Index twin = surface.twin[3 * face.face + k];
      if (twin == kNone) cross_crack(face, k);
      if (twin == kNone || seen.find(twin / 3) != kNone || !is_edge_in_cell(face, k, sides))
        continue;
      seen.insert(twin / 3, 0);
      sides.editor().fetch(twin / 3);
      const CellSides::Places places = sides.places_beyond(face.places, k, twin);
      visit({twin / 3, places, sides.is_surely_inside(sides.at(places))});
    }
  }
  sort_faces(faces, sides.memory());
  return faces;
}

}  // namespace sunder::tear
