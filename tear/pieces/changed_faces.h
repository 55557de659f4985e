#pragma once

#include "tear/internal/surface.h"
#include "tear/surface/disjoint_sets.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// The faces that the changes from `begin` to `end` created or changed, numbered, and their
/// connections.
class ChangedFaces {
 public:
  ChangedFaces(const EditLog::Mark& begin, const EditLog::Extent& end, const SurfaceEditor& editor);

  [[nodiscard]] Index count() const { return static_cast<Index>(face_.size()); }
  [[nodiscard]] Index face(Index i) const { return face_[i]; }
  [[nodiscard]] bool is_live(Index i) const {
    return face_[i] != kNone && !surface_.has_repeated_point(face_[i]);
  }
  [[nodiscard]] Index set_count() const { return set_count_ - joined_; }
  /// The connected sets of changed faces now.
  [[nodiscard]] DisjointSets& sets() { return sets_; }
  /// The connected sets before the operation. Known only if there are at least two sets.
  [[nodiscard]] DisjointSets& groups() { return groups_; }

 private:
  const Surface& surface_;
  ScratchVector<Index> face_;  ///< By number; kNone if the number has no face.
  DisjointSets sets_, groups_;
  Index set_count_ = 0, joined_ = 0;
};

}  // namespace sunder::tear
