#include "tear/pieces.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <unordered_map>

namespace sunder::tear {
namespace {

/// Sets of numbers that only ever unite.
class DisjointSets {
 public:
  Index add() {
    parent_.push_back(static_cast<Index>(parent_.size()));
    return parent_.back();
  }
  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(Index a, Index b) { parent_[find(a)] = find(b); }
  /// The root of `into` stays a root.
  void unite_into(Index into, Index from) { parent_[find(from)] = find(into); }
  [[nodiscard]] Index count() const { return static_cast<Index>(parent_.size()); }

 private:
  std::vector<Index> parent_;
};

/// Fronts that grow over the surface and become one where they meet.
class Fronts {
 public:
  explicit Fronts(const Surface& surface) : surface_(surface) {}

  void start(Index face) {
    if (!front_of_face_.emplace(face, sets_.count()).second) return;
    (void)sets_.add();
    (void)groups_.add();
    faces_.push_back({face});
    open_.push_back({0});
  }

  /// Groups the fronts by what hung together before, over edges that were opened and faces that are gone. What did not hang
  /// together need not be found to be apart.
  void group(const SurfaceEditor& editor, const SurfaceEditor::Mark& begin) {
    std::unordered_map<Index, Index> node_of_gone;
    const auto node_of = [&](Index face) {
      const auto front = front_of_face_.find(face);
      if (front != front_of_face_.end()) return front->second;
      if (!surface_.has_repeated_point(face)) return kNone;  // not touched: what joins it still does
      const auto [node, is_new] = node_of_gone.emplace(face, groups_.count());
      if (is_new) (void)groups_.add();
      return node->second;
    };
    editor.for_each_former_neighbour(begin, [&](Index one, Index other) {
      const Index a = node_of(one), b = node_of(other);
      if (a != kNone && b != kNone) groups_.unite(a, b);
    });
  }

  /// Grows until of each group at most one set of joined fronts is not exhausted, or to the end.
  void grow(bool to_the_end) {
    std::vector<Index> active(sets_.count()), growing;
    std::iota(active.begin(), active.end(), 0);
    for (;;) {
      // Fronts that meet make groups one: who has to grow is asked before any does.
      std::unordered_map<Index, Index> sets_in_group;
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
    std::vector<Index> faces;  ///< Ascending.
    bool is_exhausted = false;
  };
  /// Sets by what hung together before, of more than one each.
  [[nodiscard]] std::vector<std::vector<Set>> separated() {
    std::map<Index, std::vector<Set>> sets_of_group;
    for (Index front = 0; front < sets_.count(); ++front) {
      if (sets_.find(front) != front) continue;
      std::sort(faces_[front].begin(), faces_[front].end());
      sets_of_group[groups_.find(front)].push_back({faces_[front], open_[front].empty()});
    }
    std::vector<std::vector<Set>> separated;
    for (auto& [unused, sets] : sets_of_group)
      if (sets.size() > 1) separated.push_back(std::move(sets));
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
    sets_.unite_into(a, b);
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
      const auto [at, is_new] = front_of_face_.emplace(twin / 3, owner);
      if (is_new) {
        open_[owner].push_back(static_cast<Index>(faces_[owner].size()));
        faces_[owner].push_back(twin / 3);
      } else {
        join(owner, at->second);
      }
    }
  }

  const Surface& surface_;
  std::unordered_map<Index, Index> front_of_face_;  // asked, never walked through
  DisjointSets sets_;                               ///< Of fronts.
  DisjointSets groups_;                             ///< Of fronts and, numbered after them, of faces that are gone.
  std::vector<std::vector<Index>> faces_, open_;    ///< Of each front; open: places in faces.
};

Piece describe(const std::vector<Index>& faces, const SurfaceEditor& editor, PosedPoints& posed) {
  const Surface& surface = editor.surface();
  Piece piece;
  piece.triangle_count = static_cast<Index>(faces.size());
  std::vector<std::array<Index, 2>> triangles;
  Vec3d moment = Vec3d::Zero(), mean = Vec3d::Zero();
  for (const Index face : faces) {
    const TriangleRef& ref = surface.triangles[face];
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
  const Surface& surface = editor.surface();
  Fronts fronts(surface);
  for (const Index face : editor.touched_since(begin))
    if (!surface.has_repeated_point(face)) fronts.start(face);
  fronts.group(editor, begin);
  fronts.grow(all);
  std::vector<std::vector<Index>> sets;
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
