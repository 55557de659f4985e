#include "tear/pieces.h"

#include <algorithm>
#include <array>
#include <memory_resource>
#include <numeric>
#include <span>
#include <unordered_map>

#include "tear/scratch_memory.h"

namespace sunder::tear {
namespace {

/// Sets of numbers that only ever unite.
class DisjointSets {
 public:
  DisjointSets(Index count, ScratchMemory& scratch) : parent_(count, &scratch) { std::iota(parent_.begin(), parent_.end(), 0); }
  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The root of `into` stays a root. @return whether they were two sets.
  bool unite(Index into, Index from) {
    const Index a = find(into), b = find(from);
    parent_[b] = a;
    return a != b;
  }

 private:
  ScratchVector<Index> parent_;
};

/// Which front holds a face.
class FrontOfFace {
 public:
  /// @param of_all  most faces will be asked for.
  FrontOfFace(Index face_count, bool of_all, ScratchMemory& scratch) : of_all_(&scratch), of_some_(&scratch) {
    if (of_all) of_all_.assign(face_count, kNone);
  }
  /// @return the front that holds the face already, or `front`, which holds it from now on.
  Index claim(Index face, Index front) {
    Index& holder = of_all_.empty() ? of_some_.emplace(face, kNone).first->second : of_all_[face];
    if (holder == kNone) holder = front;
    return holder;
  }
  /// Those of all faces.
  [[nodiscard]] const ScratchVector<Index>& of_all() const { return of_all_; }

 private:
  ScratchVector<Index> of_all_;
  std::pmr::unordered_map<Index, Index> of_some_;  // asked, never walked through
};

/// Numbers of the faces that changed or were made since an operation began, and how they hang together.
class ChangedFaces {
 public:
  ChangedFaces(const SurfaceEditor::Mark& begin, const SurfaceEditor& editor)
      : surface_(editor.surface()),
        face_(editor.numbers_since(begin), kNone, &editor.scratch()),
        sets_(editor.numbers_since(begin), editor.scratch()),
        groups_(editor.numbers_since(begin), editor.scratch()) {
    editor.for_each_changed(begin, [&](Index face) { face_[editor.number_since(begin, face)] = face; });
    for (Index face = begin.triangles; face < surface_.triangle_count(); ++face) face_[editor.number_since(begin, face)] = face;
    for (Index i = 0; i < count(); ++i) {
      if (!is_live(i)) continue;
      ++set_count_;
      for (Index h = 3 * face_[i]; h < 3 * face_[i] + 3; ++h) {
        const Index twin = surface_.twin[h];
        if (twin == kNone || twin < h) continue;  // each edge once
        const Index other = editor.number_since(begin, twin / 3);
        if (other != kNone && sets_.unite(i, other)) ++joined_;
      }
    }
    if (set_count() < 2) return;
    for (Index i = 0; i < count(); ++i) groups_.unite(sets_.find(i), i);
    // What hung together before: neighbours, and what was split from one face. What did not change joins as it did.
    editor.for_each_former_neighbour(begin, [&](Index one, Index other) {
      const Index b = editor.number_since(begin, other);
      if (b != kNone) groups_.unite(editor.number_since(begin, one), b);
    });
    for (Index face = begin.triangles; face < surface_.triangle_count(); ++face)
      if (editor.parent(face) != kNone)
        groups_.unite(editor.number_since(begin, face), editor.number_since(begin, editor.parent(face)));
  }

  [[nodiscard]] Index count() const { return static_cast<Index>(face_.size()); }
  [[nodiscard]] Index face(Index i) const { return face_[i]; }
  [[nodiscard]] bool is_live(Index i) const { return face_[i] != kNone && !surface_.has_repeated_point(face_[i]); }
  [[nodiscard]] Index set_count() const { return set_count_ - joined_; }
  [[nodiscard]] DisjointSets& sets() { return sets_; }
  [[nodiscard]] DisjointSets& groups() { return groups_; }

 private:
  const Surface& surface_;
  ScratchVector<Index> face_;  ///< Of each number; kNone for one that stands for no face.
  DisjointSets sets_;          ///< What hangs together now, as far as it changed.
  DisjointSets groups_;        ///< What hung together before.
  Index set_count_ = 0, joined_ = 0;
};

/// Fronts that grow over the surface, one from each set of changed faces, and become one where they meet.
class Fronts {
 public:
  Fronts(ChangedFaces& changed, bool of_all, const SurfaceEditor& editor)
      : surface_(editor.surface()),
        scratch_(editor.scratch()),
        groups_(changed.groups()),
        sets_(changed.sets()),
        front_of_face_(surface_.triangle_count(), of_all, scratch_),
        faces_(changed.count(), ScratchVector<Index>(&scratch_), &scratch_),
        open_(faces_, &scratch_),
        roots_(&scratch_) {
    for (Index i = 0; i < changed.count(); ++i) {
      if (!changed.is_live(i)) continue;
      const Index front = sets_.find(i);
      if (faces_[front].empty()) roots_.push_back(front);
      front_of_face_.claim(changed.face(i), front);
      open_[front].push_back(static_cast<Index>(faces_[front].size()));
      faces_[front].push_back(changed.face(i));
    }
  }

  /// Grows until of each group at most one set of joined fronts is not exhausted, or to the end.
  void grow(bool to_the_end) {
    ScratchVector<Index> active(roots_, &scratch_), growing(&scratch_);
    std::pmr::unordered_map<Index, Index> sets_in_group(&scratch_);
    for (;;) {
      // Fronts that meet make groups one: who has to grow is asked before any does.
      sets_in_group.clear();
      for (const Index front : active) ++sets_in_group[groups_.find(front)];
      growing.clear();
      for (const Index front : active)
        if (to_the_end || sets_in_group[groups_.find(front)] > 1) growing.push_back(front);
      if (growing.empty()) return;
      for (const Index front : growing)
        for (std::size_t turn = 0; turn < kFacesATurn && !open_[front].empty(); ++turn) grow_once(front);
      for (Index& front : active) front = sets_.find(front);
      std::sort(active.begin(), active.end());
      active.erase(std::unique(active.begin(), active.end()), active.end());
      active.erase(std::remove_if(active.begin(), active.end(), [&](Index front) { return open_[front].empty(); }), active.end());
    }
  }

  /// Fronts that joined.
  struct Set {
    ScratchVector<Index> faces;  ///< Ascending.
    bool is_exhausted = false;
  };
  /// Sets by what hung together before, of more than one each.
  [[nodiscard]] ScratchVector<ScratchVector<Set>> separated() {
    if (!front_of_face_.of_all().empty()) {  // in order without sorting
      for (const Index front : roots_)
        if (sets_.find(front) == front) faces_[front].clear();
      for (Index face = 0; face < surface_.triangle_count(); ++face)
        if (const Index front = front_of_face_.of_all()[face]; front != kNone) faces_[sets_.find(front)].push_back(face);
    }
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
        if (front_of_face_.of_all().empty()) std::sort(faces.begin(), faces.end());
        sets.push_back({std::move(faces), open_[by_group[i][1]].empty()});
      }
    }
    return separated;
  }

 private:
  static constexpr std::size_t kFacesATurn = 8;

  /// Smaller into larger, so that no face is moved often.
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
      const Index holder = front_of_face_.claim(twin / 3, kNone);
      if (holder == kNone) {
        front_of_face_.claim(twin / 3, owner);
        open_[owner].push_back(static_cast<Index>(faces_[owner].size()));
        faces_[owner].push_back(twin / 3);
      } else {
        join(owner, holder);
      }
    }
  }

  const Surface& surface_;
  ScratchMemory& scratch_;
  DisjointSets &groups_, &sets_;
  FrontOfFace front_of_face_;
  ScratchVector<ScratchVector<Index>> faces_, open_;  ///< Of each front; open: places in faces.
  ScratchVector<Index> roots_;                        ///< The fronts as they started.
};

Piece describe(std::span<const Index> faces, const SurfaceEditor& editor, PosedPoints& posed) {
  const Surface& surface = editor.surface();
  Piece piece;
  piece.triangle_count = static_cast<Index>(faces.size());
  std::vector<std::array<Index, 2>> triangles;
  Vec3d moment = Vec3d::Zero(), mean = Vec3d::Zero();
  for (const Index face : faces) {
    const TriangleRef ref = surface.triangle(face);
    triangles.push_back({ref.mesh, ref.triangle});
    std::array<Vec3d, 3> corners;
    for (Index k = 0; k < 3; ++k) corners[k] = posed.position(editor, surface.corner_point[3 * face + k]);
    const double area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    const Vec3d middle = (corners[0] + corners[1] + corners[2]) / 3;
    piece.area_posed += area;
    moment += area * middle;
    mean += middle / static_cast<double>(faces.size());
    const Mesh& mesh = editor.character().meshes[ref.mesh];
    const Skin& skin = editor.character().skins[mesh.skin];
    for (const Index vertex : mesh.triangles[ref.triangle])
      for (const Influence& influence : mesh.weights.of(vertex)) piece.bones.push_back(skin.bones[influence.slot]);
  }
  piece.centroid_posed = piece.area_posed > 0 ? Vec3d(moment / piece.area_posed) : mean;
  std::sort(piece.bones.begin(), piece.bones.end());
  piece.bones.erase(std::unique(piece.bones.begin(), piece.bones.end()), piece.bones.end());
  std::sort(triangles.begin(), triangles.end());
  for (const auto& [mesh, triangle] : triangles) {
    if (piece.meshes.empty() || piece.meshes.back().mesh != mesh) piece.meshes.push_back({mesh, {}});
    piece.meshes.back().triangles.push_back(triangle);
  }
  return piece;
}

}  // namespace

std::vector<Piece> find_pieces(const SurfaceEditor::Mark& begin, bool all, const SurfaceEditor& editor, PosedPoints& posed) {
  ChangedFaces changed(begin, editor);
  if (changed.set_count() < 2) return {};
  Fronts fronts(changed, all, editor);
  fronts.grow(all);
  ScratchVector<ScratchVector<Index>> sets(&editor.scratch());
  for (auto& of_group : fronts.separated()) {
    // What is left is the part that did not run out or, where all did, the largest.
    const auto left = std::max_element(of_group.begin(), of_group.end(), [](const Fronts::Set& a, const Fronts::Set& b) {
      return a.is_exhausted != b.is_exhausted ? a.is_exhausted : a.faces.size() < b.faces.size();
    });
    for (auto set = of_group.begin(); set != of_group.end(); ++set)
      if (all || set != left) sets.push_back(std::move(set->faces));
  }
  std::sort(sets.begin(), sets.end());
  std::vector<Piece> pieces;
  for (const auto& faces : sets) pieces.push_back(describe(faces, editor, posed));
  return pieces;
}

}  // namespace sunder::tear
