#include "tear/weld/fillings_at_lips.h"

#include <algorithm>
#include <array>

#include "tear/surface/disjoint_sets.h"
#include "tear/surface/index_map.h"

namespace sunder::tear {
namespace {

/// The fillings of a mesh in the order in which they were made. Those below one edge of a lip
/// follow one another, and the first of them begins with that edge (LipStrip in lip_walls.cpp).
class FillingsInOrder {
 public:
  explicit FillingsInOrder(const SurfaceEditor& editor) : editor_(editor) {}

  [[nodiscard]] bool is_filling(const TriangleRef& of) const {
    return of.source_triangle >= first_of(of.mesh);
  }
  [[nodiscard]] Index group(const TriangleRef& of) const {
    return editor_.fillings.group(of.mesh, of.source_triangle);
  }
  /// The first filling after the part of a wall that begins with one.
  [[nodiscard]] Index end_of_part(const TriangleRef& top) const {
    const Index end = first_of(top.mesh) + static_cast<Index>(editor_.fillings.of(top.mesh).size());
    Index at = top.source_triangle + 1;
    while (at < end && editor_.fillings.group(top.mesh, at) == group(top) &&
           !begins_part({top.mesh, 0, at}))
      ++at;
    return at;
  }

 private:
  [[nodiscard]] Index first_of(Index mesh) const {
    return editor_.source().meshes[mesh].triangle_count();
  }
  [[nodiscard]] bool begins_part(const TriangleRef& of) const {
    const Triangle& vertices = editor_.fillings.origin_triangle(of.mesh, of.source_triangle);
    return is_on_lip(of, vertices[0]) && is_on_lip(of, vertices[1]);
  }
  /// Vertices at a lip are copies of those of the skin; others were made with the wall.
  [[nodiscard]] bool is_on_lip(const TriangleRef& of, Index vertex) const {
    const VertexRef original = editor_.births.original(of.mesh, vertex);
    if (original.vertex < editor_.source().meshes[original.mesh].vertex_count()) return true;
    const TriangleRef born = {original.mesh, 0,
                              editor_.births.at(original.mesh, original.vertex).triangle};
    return !is_filling(born) || born.mesh != of.mesh || group(born) != group(of);
  }

  const SurfaceEditor& editor_;
};

/// Adds what is left of a cap: of the fillings of its group that have common vertices.
void add_cap(const TriangleRef& of, const SurfaceEditor& editor, ScratchVector<Index>& faces) {
  const auto& fillings = editor.fillings;
  const Index first = editor.source().meshes[of.mesh].triangle_count(),
              end = first + static_cast<Index>(fillings.of(of.mesh).size());
  const Index group = fillings.group(of.mesh, of.source_triangle);
  ScratchVector<std::array<Index, 2>> corners(&editor.scratch());  // vertex, filling
  for (Index origin = first; origin < end; ++origin)
    for (const Index vertex : fillings.origin_triangle(of.mesh, origin))
      if (fillings.group(of.mesh, origin) == group) corners.push_back({vertex, origin - first});
  std::sort(corners.begin(), corners.end());
  DisjointSets caps(end - first, editor.scratch());
  for (std::size_t i = 1; i < corners.size(); ++i)
    if (corners[i][0] == corners[i - 1][0]) caps.unite(corners[i - 1][1], corners[i][1]);
  const Index wanted = caps.find(of.source_triangle - first);
  for (Index origin = first; origin < end; ++origin)
    if (fillings.group(of.mesh, origin) == group && caps.find(origin - first) == wanted)
      editor.origins.for_each_part(of.mesh, origin, [&](Index face) { faces.push_back(face); });
}

bool contains(const ScratchVector<Index>& ascending, Index face) {
  return std::binary_search(ascending.begin(), ascending.end(), face);
}

/// Adds to `loose` the fillings that are connected with one of them, unless they lead to other
/// faces than fillings and those that go.
void find_loose(Index start, const ScratchVector<Index>& going, const FillingsInOrder& fillings,
                const SurfaceEditor& editor, ScratchVector<Index>& loose) {
  const Surface& surface = editor.surface();
  ScratchVector<Index> faces(&editor.scratch());
  IndexMap known(8, editor.scratch());
  faces.push_back(start);
  known.insert(start, 0);
  for (std::size_t next = 0; next < faces.size(); ++next)
    for (Index h = 3 * faces[next]; h < 3 * faces[next] + 3; ++h) {
      const Index other = surface.twin[h] == kNone ? kNone : surface.twin[h] / 3;
      if (other == kNone || contains(going, other)) continue;
      if (!fillings.is_filling(surface.triangle(other))) return;
      if (known.insert(other, 0) == kNone) faces.push_back(other);
    }
  loose.insert(loose.end(), faces.begin(), faces.end());
}

void sort_once(ScratchVector<Index>& faces) {
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
}

/// Adds the walls and caps that only hang from those that go.
void add_loose(const FillingsInOrder& fillings, const SurfaceEditor& editor,
               ScratchVector<Index>& faces) {
  const Surface& surface = editor.surface();
  ScratchVector<Index> loose(&editor.scratch());
  for (const Index face : faces)
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const Index other = surface.twin[h] == kNone ? kNone : surface.twin[h] / 3;
      if (other != kNone && fillings.is_filling(surface.triangle(other)) &&
          !contains(faces, other) && std::find(loose.begin(), loose.end(), other) == loose.end())
        find_loose(other, faces, fillings, editor, loose);
    }
  faces.insert(faces.end(), loose.begin(), loose.end());
  sort_once(faces);
}

}  // namespace

ScratchVector<Index> fillings_at_lips(std::span<const Index> half_edges,
                                      const SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  const FillingsInOrder fillings(editor);
  ScratchVector<Index> faces(&editor.scratch());
  IndexMap known(half_edges.size(), editor.scratch());  // of caps
  for (const Index h : half_edges) {
    if (surface.twin[h] == kNone) continue;
    const TriangleRef of = surface.triangle(surface.twin[h] / 3);
    if (!editor.fillings.is_wall(of)) {
      if (known.find(surface.twin[h] / 3) != kNone) continue;
      const std::size_t before = faces.size();
      add_cap(of, editor, faces);
      for (std::size_t i = before; i < faces.size(); ++i) known.insert(faces[i], 0);
      continue;
    }
    for (Index origin = of.source_triangle, end = fillings.end_of_part(of); origin < end; ++origin)
      editor.origins.for_each_part(of.mesh, origin, [&](Index face) { faces.push_back(face); });
  }
  sort_once(faces);
  add_loose(fillings, editor, faces);
  return faces;
}

}  // namespace sunder::tear
