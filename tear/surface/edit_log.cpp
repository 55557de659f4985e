#include "tear/surface/edit_log.h"

#include <utility>

namespace sunder::tear {

EditLog::Mark EditLog::mark(Index next_side, Index opened_changes) {
  newest_mark_ = {columns_.surface.point_count(),
                  columns_.surface.triangle_count(),
                  static_cast<Index>(columns_.vertex_mesh.size()),
                  static_cast<Index>(columns_.additions.size()),
                  static_cast<Index>(columns_.kept_births.size()),
                  next_side,
                  static_cast<Index>(columns_.triangle_changes.size()),
                  static_cast<Index>(columns_.side_changes.size()),
                  opened_changes,
                  static_cast<Index>(columns_.scars.size()),
                  static_cast<Index>(columns_.threads.size())};
  return newest_mark_;
}

TriangleChange EditLog::describe(Index triangle) const {
  TriangleChange now{triangle, kNone, {}, {}, {}, {}};
  const Surface& surface = columns_.surface;
  const TriangleRef ref = surface.triangle(triangle);
  now.vertices = character_.meshes[ref.mesh].triangles[ref.triangle];
  for (Index k = 0; k < 3; ++k) {
    const Index point = surface.corner_point[3 * triangle + k];
    now.points[k] = point;
    now.twins[k] = surface.twin[3 * triangle + k];
    now.point_corners[k] = point == kNone ? kNone : surface.point_corner[point];
  }
  return now;
}

void EditLog::append(Index triangle, Index previous) {
  auto& changes = columns_.triangle_changes;
  changes.push_back(describe(triangle));
  changes.back().previous = previous;
  columns_.newest_change[triangle] = static_cast<Index>(changes.size() - 1);
}

Index EditLog::first_twin(Index half_edge) const {
  const auto& changes = columns_.triangle_changes;
  Index first = columns_.newest_change[half_edge / 3];
  if (first == kNone) return columns_.surface.twin[half_edge];
  while (changes[first].previous != kNone) first = changes[first].previous;
  return changes[first].twins[half_edge % 3];
}

void EditLog::restore(const TriangleChange& change) {
  Surface& surface = columns_.surface;
  const TriangleRef ref = surface.triangle(change.triangle);
  character_.meshes[ref.mesh].triangles[ref.triangle] = change.vertices;
  for (Index k = 0; k < 3; ++k) {
    surface.corner_point[3 * change.triangle + k] = change.points[k];
    surface.twin[3 * change.triangle + k] = change.twins[k];
    if (change.points[k] != kNone) surface.point_corner[change.points[k]] = change.point_corners[k];
  }
}

void EditLog::drop_inner_changes(const Mark& begin) {
  auto& changes = columns_.triangle_changes;
  auto& newest = columns_.newest_change;
  Index kept = begin.triangle_changes;
  for (Index i = kept; i < changes.size(); ++i) {
    const auto [triangle, previous] = std::pair(changes[i].triangle, changes[i].previous);
    if (triangle >= begin.triangles) {
      newest[triangle] = kNone;
    } else if (previous == kNone || previous < begin.triangle_changes) {
      if (kept != i) changes[kept] = changes[i];
      newest[triangle] = kept++;
    }
  }
  changes.erase(changes.begin() + kept, changes.end());
}

void EditLog::restore_since(const Mark& mark) {
  auto& changes = columns_.triangle_changes;
  for (; changes.size() > mark.triangle_changes; changes.pop_back()) {
    restore(changes.back());
    columns_.newest_change[changes.back().triangle] = changes.back().previous;
  }
}

RowCounts EditLog::rows_since(const Mark& mark) const {
  RowCounts rows;
  rows[Rows::triangles] = columns_.surface.triangle_count() - mark.triangles;
  rows[Rows::points] = columns_.surface.point_count() - mark.points;
  rows[Rows::vertices] = vertices_since(mark);
  rows[Rows::additions] = static_cast<Index>(columns_.additions.size()) - mark.additions;
  rows[Rows::kept_births] = static_cast<Index>(columns_.kept_births.size()) - mark.kept_births;
  if (rows[Rows::kept_births] > 0)
    rows[Rows::kept_influences] = static_cast<Index>(columns_.kept_influences.size()) -
                                  columns_.kept_births[mark.kept_births].first_influence;
  rows[Rows::triangle_changes] =
      static_cast<Index>(columns_.triangle_changes.size()) - mark.triangle_changes;
  rows[Rows::side_changes] = static_cast<Index>(columns_.side_changes.size()) - mark.side_changes;
  rows[Rows::scars] = static_cast<Index>(columns_.scars.size()) - mark.scars;
  rows[Rows::threads] = static_cast<Index>(columns_.threads.size()) - mark.threads;
  return rows;
}

std::span<const RowCounts> EditLog::mesh_rows_since(const Mark& mark) const {
  const Surface& surface = columns_.surface;
  for (RowCounts& rows : mesh_rows_) rows = {};
  if (mesh_rows_.size() == 1) {
    mesh_rows_[0][Rows::mesh_vertices] = vertices_since(mark);
    mesh_rows_[0][Rows::mesh_triangles] = surface.triangle_count() - mark.triangles;
  } else {
    for (Index i = mark.vertices; i < columns_.vertex_mesh.size(); ++i)
      ++mesh_rows_[columns_.vertex_mesh[i]][Rows::mesh_vertices];
    for (Index t = mark.triangles; t < surface.triangle_count(); ++t)
      ++mesh_rows_[surface.triangle(t).mesh][Rows::mesh_triangles];
  }
  for (Index i = mark.additions; i < columns_.additions.size(); ++i) {
    const Addition& addition = columns_.additions[i];
    if (addition.kind == Addition::Kind::filling) ++mesh_rows_[addition.mesh][Rows::mesh_fillings];
    if (addition.kind == Addition::Kind::submesh) ++mesh_rows_[addition.mesh][Rows::mesh_submeshes];
  }
  return mesh_rows_;
}

std::vector<Index> EditLog::vertex_counts_at(const Mark& mark) const {
  std::vector<Index> counts;
  for (const Mesh& mesh : character_.meshes) counts.push_back(mesh.vertex_count());
  const std::span<const RowCounts> rows = mesh_rows_since(mark);
  for (std::size_t m = 0; m < counts.size(); ++m) counts[m] -= rows[m][Rows::mesh_vertices];
  return counts;
}

}  // namespace sunder::tear
