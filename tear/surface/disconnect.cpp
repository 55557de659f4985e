#include "tear/surface/disconnect.h"

#include <algorithm>

namespace sunder::tear {
namespace {

/// The fans of a point that is separated, except the fan that moves.
class RemainingFans {
 public:
  RemainingFans(std::span<const Index> corners, const SurfaceEditor& editor)
      : corners_(corners), editor_(editor) {}

  /// Whether faces outside the moved fan use a vertex.
  [[nodiscard]] bool use(Index mesh, Index vertex) const {
    const auto& is_shared = editor_.surface().is_shared_vertex[mesh];
    if (vertex < is_shared.size() && is_shared[vertex]) return true;
    return std::any_of(corners_.begin(), corners_.end(), [&](Index corner) {
      if (is_at(corner, mesh, vertex)) return true;
      bool is_used = false;
      editor_.surface().for_each_in_fan(
          corner, [&](Index c) { is_used = is_used || is_at(c, mesh, vertex); });
      return is_used;
    });
  }

 private:
  [[nodiscard]] bool is_at(Index corner, Index mesh, Index vertex) const {
    return editor_.vertex_at(corner) == vertex &&
           editor_.surface().triangle(corner / 3).mesh == mesh;
  }

  std::span<const Index> corners_;  ///< One per fan.
  const SurfaceEditor& editor_;
};

void make_room_to_separate(std::span<const Index> corners, SurfaceEditor& editor) {
  editor.room.make_for_changes(corners.size());
  Index last_vertex = kNone;
  for (const Index c : corners) {
    if (editor.vertex_at(c) == last_vertex) continue;
    last_vertex = editor.vertex_at(c);
    const Index mesh = editor.surface().triangle(c / 3).mesh;
    const std::size_t influences = editor.character().meshes[mesh].weights.of(last_vertex).size();
    editor.room.make_for_vertices(mesh, static_cast<Index>(corners.size()),
                                  static_cast<Index>(corners.size() * influences));
  }
}

}  // namespace

void cut_edge(Index half_edge, SurfaceEditor& editor) {
  Surface& surface = editor.connectivity.surface();
  const Index twin = surface.twin[half_edge];
  if (twin == kNone) return;
  editor.opened_edges.add(half_edge, twin);
  editor.room.make_for_changes(2);
  editor.log.keep(half_edge / 3);
  editor.log.keep(twin / 3);
  surface.twin[half_edge] = kNone;
  surface.twin[twin] = kNone;
}

Index separate_fan(std::span<const Index> corners, std::span<const Index> remaining,
                   SurfaceEditor& editor) {
  struct Duplicate {
    Index mesh, vertex, copy;
  };
  Connectivity& connectivity = editor.connectivity;
  const Surface& surface = editor.surface();
  const RemainingFans remaining_fans(remaining, editor);
  const Index old_point = surface.corner_point[corners.front()];
  make_room_to_separate(corners, editor);
  ScratchVector<Duplicate> duplicates(&editor.scratch());
  duplicates.reserve(corners.size());
  for (const Index c : corners) editor.log.keep(c / 3);
  const Index point = connectivity.append_point();
  const Index side = surface.side(point);
  for (const Index c : corners) {
    const TriangleRef ref = surface.triangle(c / 3);
    const Index mesh = ref.mesh, vertex = editor.vertex_at(c);
    auto known = std::find_if(duplicates.begin(), duplicates.end(), [&](const Duplicate& d) {
      return d.mesh == mesh && d.vertex == vertex;
    });
    if (known == duplicates.end()) {
      Index copy = vertex;
      if (remaining_fans.use(mesh, vertex)) {
        copy = editor.births.append_duplicate(mesh, vertex, ref);
        editor.sides.write_to_new(mesh, copy, side);
      } else {
        editor.sides.write(mesh, vertex, side);
      }
      known = duplicates.insert(duplicates.end(), {mesh, vertex, copy});
    }
    connectivity.set_corner(c, point, known->copy);
  }
  connectivity.set_point_corner(point, corners.front());
  if (!remaining.empty()) connectivity.set_point_corner(old_point, remaining.front());
  return point;
}

Index separate_left_fan(const PathThroughPoint& path, SurfaceEditor& editor) {
  const auto& [arriving, leaving, across_arriving, across_leaving] = path;
  Connectivity& connectivity = editor.connectivity;
  Surface& surface = editor.connectivity.surface();
  for (const Index h : {arriving, leaving, across_arriving, across_leaving})
    if (h == kNone || surface.twin[h] != kNone) return kNone;
  const Index mesh = surface.triangle(leaving / 3).mesh, vertex = editor.vertex_at(leaving);
  const std::vector<Triangle>& triangles = editor.character().meshes[mesh].triangles;
  const auto leads_to = [&](Index first, Index last, Index& count) {
    for (Index c = first, following = kNone;; c = following) {
      const TriangleRef ref = surface.triangle(c / 3);
      if (ref.mesh != mesh || triangles[ref.triangle][c % 3] != vertex) return false;
      ++count;
      following = surface.rotate_ccw(c);
      if (following == kNone) return c == last;
    }
  };
  Index left = 0, right = 0;
  if (!leads_to(leaving, Surface::next(arriving), left) ||
      !leads_to(across_arriving, Surface::next(across_leaving), right))
    return kNone;
  editor.room.make_for_changes(left);
  editor.room.make_for_vertices(
      mesh, 1, static_cast<Index>(editor.character().meshes[mesh].weights.of(vertex).size()));
  for (Index c = leaving; c != kNone; c = surface.rotate_ccw(c)) editor.log.keep(c / 3);
  const Index old_point = surface.corner_point[leaving], point = connectivity.append_point();
  const Index copy = editor.births.append_duplicate(mesh, vertex, surface.triangle(leaving / 3));
  editor.sides.write_to_new(mesh, copy, surface.side(point));
  for (Index c = leaving; c != kNone; c = surface.rotate_ccw(c))
    connectivity.set_corner(c, point, copy);
  surface.point_corner[point] = leaving;
  surface.point_corner[old_point] = across_arriving;
  return point;
}

void retire_triangle(Index triangle, SurfaceEditor& editor) {
  Connectivity& connectivity = editor.connectivity;
  Surface& surface = editor.connectivity.surface();
  editor.room.make_for_changes(1);
  editor.log.keep(triangle);
  const Index vertex = connectivity.vertices_of(triangle)[0];
  connectivity.set_vertices(triangle, {vertex, vertex, vertex});
  const auto first = static_cast<std::ptrdiff_t>(3 * triangle);
  std::fill_n(surface.corner_point.begin() + first, 3, kNone);
  std::fill_n(surface.twin.begin() + first, 3, kNone);
}

}  // namespace sunder::tear
