#include "tear/pieces/pieces.h"

#include <algorithm>
#include <array>
#include <memory_resource>
#include <span>
#include <unordered_map>

#include "tear/internal/surface.h"
#include "tear/pieces/changed_faces.h"
#include "tear/pieces/piece_description.h"

namespace sunder::tear {
namespace {

/// Fronts that grow over the surface, one from each set of changed faces, and are merged where they
/// meet.
class Fronts {
 public:
  Fronts(ChangedFaces& changed, const SurfaceEditor& editor)
      : surface_(editor.surface()),
        scratch_(editor.scratch()),
        groups_(changed.groups()),
        sets_(changed.sets()),
        front_of_face_(&scratch_),
        faces_(changed.count(), ScratchVector<Index>(&scratch_), &scratch_),
        open_(faces_, &scratch_),
        roots_(&scratch_) {
    for (Index i = 0; i < changed.count(); ++i) {
      if (!changed.is_live(i)) continue;
      const Index front = sets_.find(i);
      if (faces_[front].empty()) roots_.push_back(front);
      front_of_face_.emplace(changed.face(i), front);
      open_[front].push_back(static_cast<Index>(faces_[front].size()));
      faces_[front].push_back(changed.face(i));
    }
  }

  /// Grows until in each group all but at most one set of merged fronts are exhausted.
  void grow() {
    ScratchVector<Index> active(roots_, &scratch_), growing(&scratch_);
    std::pmr::unordered_map<Index, Index> sets_in_group(&scratch_);
    for (;;) {
      // Merging fronts merges groups, so it is decided who grows before any front does.
      sets_in_group.clear();
      for (const Index front : active) ++sets_in_group[groups_.find(front)];
      growing.clear();
      for (const Index front : active)
        if (sets_in_group[groups_.find(front)] > 1) growing.push_back(front);
      if (growing.empty()) return;
      for (const Index front : growing)
        for (std::size_t turn = 0; turn < kFacesATurn && !open_[front].empty(); ++turn)
          grow_once(front);
      for (Index& front : active) front = sets_.find(front);
      std::sort(active.begin(), active.end());
      active.erase(std::unique(active.begin(), active.end()), active.end());
      active.erase(std::remove_if(active.begin(), active.end(),
                                  [&](Index front) { return open_[front].empty(); }),
                   active.end());
    }
  }

  /// Merged fronts.
  struct Set {
    ScratchVector<Index> faces;  ///< Ascending.
    bool is_exhausted = false;
  };
  /// The sets of each group that has several.
  [[nodiscard]] ScratchVector<ScratchVector<Set>> separated() {
    ScratchVector<std::array<Index, 2>> by_group(&scratch_);  // group, front
    for (const Index front : roots_)
      if (sets_.find(front) == front) by_group.push_back({groups_.find(front), front});
    std::sort(by_group.begin(), by_group.end());
    ScratchVector<ScratchVector<Set>> separated(&scratch_);
    for (std::size_t begin = 0, end = 0; begin < by_group.size(); begin = end) {
      while (end < by_group.size() && by_group[end][0] == by_group[begin][0]) ++end;
      if (end - begin < 2) continue;
      auto& sets = separated.emplace_back();
      for (std::size_t i = begin; i < end; ++i) {
        ScratchVector<Index>& faces = faces_[by_group[i][1]];
        std::sort(faces.begin(), faces.end());
        sets.push_back({std::move(faces), open_[by_group[i][1]].empty()});
      }
    }
    return separated;
  }

 private:
  static constexpr std::size_t kFacesATurn = 8;

  /// Appends the smaller set to the larger one, so that a face is moved rarely.
  void join(Index a, Index b) {
    a = sets_.find(a);
    b = sets_.find(b);
    if (a == b) return;
    if (faces_[a].size() < faces_[b].size()) std::swap(a, b);
    sets_.unite(a, b);
    groups_.unite(a, b);
    const auto offset = static_cast<Index>(faces_[a].size());
    faces_[a].insert(faces_[a].end(), faces_[b].begin(), faces_[b].end());
    for (const Index at : open_[b]) open_[a].push_back(offset + at);
    faces_[b].clear();
    open_[b].clear();
  }

  void grow_once(Index front) {
    const Index face = faces_[front][open_[front].back()];
    open_[front].pop_back();
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const Index twin = surface_.twin[h];
      if (twin == kNone) continue;
      const Index owner = sets_.find(front);
      const auto [held, is_new] = front_of_face_.emplace(twin / 3, owner);
      if (is_new) {
        open_[owner].push_back(static_cast<Index>(faces_[owner].size()));
        faces_[owner].push_back(twin / 3);
      } else {
        join(owner, held->second);
      }
    }
  }

  const Surface& surface_;
  ScratchMemory& scratch_;
  DisjointSets &groups_, &sets_;
  std::pmr::unordered_map<Index, Index> front_of_face_;  // lookups only, never iterated
  /// Per front: its faces, and the indices in them of those that can still grow.
  ScratchVector<ScratchVector<Index>> faces_, open_;
  ScratchVector<Index> roots_;  ///< The initial fronts.
};

}  // namespace

std::vector<TornPiece> find_pieces(const EditLog::Mark& begin, const SurfaceEditor& editor,
                                   PosedPoints& posed) {
  ChangedFaces changed(begin, editor);
  if (changed.set_count() < 2) return {};
  Fronts fronts(changed, editor);
  fronts.grow();
  ScratchVector<ScratchVector<Index>> sets(&editor.scratch());
  for (auto& of_group : fronts.separated()) {
    // The remaining part is the one that is not exhausted or, if all are, the largest.
    const auto left = std::max_element(
        of_group.begin(), of_group.end(), [](const Fronts::Set& a, const Fronts::Set& b) {
          return a.is_exhausted != b.is_exhausted ? a.is_exhausted
                                                  : a.faces.size() < b.faces.size();
        });
    for (auto set = of_group.begin(); set != of_group.end(); ++set)
      if (set != left) sets.push_back(std::move(set->faces));
  }
  std::sort(sets.begin(), sets.end());
  std::vector<TornPiece> pieces;
  for (const auto& faces : sets) {
    PieceDescription description(editor, posed);
    for (const Index face : faces) description.add(face);
    pieces.push_back(description.piece());
  }
  return pieces;
}

}  // namespace sunder::tear
