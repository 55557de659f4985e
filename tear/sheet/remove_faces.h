#pragma once

#include <array>
#include <span>

#include "tear/posed/posed_points.h"
#include "tear/surface/disjoint_sets.h"
#include "tear/surface/index_map.h"

namespace sunder::tear {

/// Faces that are to be removed, and the border between them and the remaining ones. The border is
/// found before the removal and can be described after it, when points have their final indices.
class RemovedFaces {
 public:
  /// A border half-edge of a remaining face.
  struct BorderEdge {
    Index half_edge;
    Index face;  ///< Index in the removed faces of the one on its other side.
  };

  /// @param faces  each once. They must outlive this object.
  /// @param connected  optional, as many as there are faces: those with a common edge are united.
  RemovedFaces(std::span<const Index> faces, const SurfaceEditor& editor,
               DisjointSets* connected = nullptr);

  /// Index of a face among the removed faces; kNone if it remains.
  [[nodiscard]] Index find(Index face) const {
    return face < first_newest_ ? number_.find(face) : of_newest_[face - first_newest_];
  }
  /// In the order of the removed faces.
  [[nodiscard]] std::span<const BorderEdge> border() const { return border_; }

  /// Retires the faces, and gives each remaining fan at their points a point of its own.
  void remove(SurfaceEditor& editor, PosedPoints& posed) const;

 private:
  void separate_fans(SurfaceEditor& editor, PosedPoints& posed) const;

  std::span<const Index> faces_;
  IndexMap number_;
  Index first_newest_;              ///< Of the stage.
  ScratchVector<Index> of_newest_;  ///< The same per triangle of the stage.
  ScratchVector<BorderEdge> border_;
};

}  // namespace sunder::tear
