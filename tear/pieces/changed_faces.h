#pragma once

#include "tear/internal/surface.h"
#include "tear/surface/disjoint_sets.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Numbers of the faces that changed or were made since an operation began, and how they hang
/// together.
class ChangedFaces {
 public:
  ChangedFaces(const SurfaceEditor::Mark& begin, const SurfaceEditor& editor);

  [[nodiscard]] Index count() const { return static_cast<Index>(face_.size()); }
  [[nodiscard]] Index face(Index i) const { return face_[i]; }
  [[nodiscard]] bool is_live(Index i) const {
    return face_[i] != kNone && !surface_.has_repeated_point(face_[i]);
  }
  [[nodiscard]] Index set_count() const { return set_count_ - joined_; }
  /// What hangs together now, as far as it changed.
  [[nodiscard]] DisjointSets& sets() { return sets_; }
  /// What hung together before. Known where there are two sets at least.
  [[nodiscard]] DisjointSets& groups() { return groups_; }

 private:
  const Surface& surface_;
  ScratchVector<Index> face_;  ///< Of each number; kNone for one that stands for no face.
  DisjointSets sets_, groups_;
  Index set_count_ = 0, joined_ = 0;
};

}  // namespace sunder::tear
