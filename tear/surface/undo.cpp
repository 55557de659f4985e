#include <algorithm>
#include <iterator>

#include "tear/surface/describe_change.h"
#include "tear/surface/sort_by_index.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {

void SurfaceEditor::Redo::clear() {
  changed.clear();
  known_corners.clear();
  sides.clear();
  end.reset();
}

void SurfaceEditor::keep_rows(const EditLog::Mark& begin, Redo& redo) {
  const RowCounts rows = log.rows_since(begin);
  const std::span<const RowCounts> mesh_rows = log.mesh_rows_since(begin);
  ModelColumns all = all_columns();
  redo.tails.meshes.resize(all.meshes.size());
  redo.tails.edit.meshes.resize(all.meshes.size());
  for_each_common_column(
      [&](const Column& column, auto&& values, auto&& tail) {
        if (column.is_kept) copy_last(column.per_row * rows[column.rows], values, tail);
      },
      all, redo.tails);
  for (Index m = 0; m < all.meshes.size(); ++m)
    for_each_mesh_column(
        m,
        [&](const Column& column, auto&& values, auto&& tail) {
          if (column.is_kept) copy_last(column.per_row * mesh_rows[m][column.rows], values, tail);
        },
        all, redo.tails);
}

/// Keeps the state in which the operation left old triangles, points and vertices.
void SurfaceEditor::keep_changes(const EditLog::Mark& begin, Redo& redo) {
  redo.next_side = sides.next();
  for (const SideChange& change : redo.tails.edit.side_changes)
    redo.sides.push_back({change.mesh, change.vertex, sides.at(change.mesh, change.vertex)});
  const ScratchMemory::Frame memory_of_step(scratch_);
  ScratchVector<Index> changed(&scratch_);
  changed.reserve(log.numbers_since(begin));
  log.for_each_changed(begin, [&](Index triangle) { changed.push_back(triangle); });
  sort_by_index(
      changed, [](Index triangle) { return triangle; }, scratch_);
  for (const Index triangle : changed) redo.changed.push_back(log.describe(triangle));
  for (const TriangleChange& change : redo.tails.edit.triangle_changes)
    for (const Index point : change.points)
      if (point != kNone && point < begin.points)
        redo.known_corners.push_back({point, surface().point_corner[point]});
}

void SurfaceEditor::Redo::shrink() noexcept {
  std::sort(known_corners.begin(), known_corners.end());
  known_corners.erase(std::unique(known_corners.begin(), known_corners.end()), known_corners.end());
  // Memory that cannot be returned is kept: shrink_to_fit() does not fail.
  changed.shrink_to_fit();
  known_corners.shrink_to_fit();
  sides.shrink_to_fit();
  for (Mesh& mesh : tails.meshes) mesh.weights.first.shrink_to_fit();
}

void SurfaceEditor::undo(const EditLog::Mark& begin, Redo& redo, ChangeRecord* change) {
  if (redo.end != log.mark(sides.next(), 0)) {
    redo.clear();
    keep_rows(begin, redo);
    keep_changes(begin, redo);
  }
  if (change != nullptr) describe_roll_back(begin, *this, *change);
  keep_names(redo);
  roll_back(begin);
}

/// Moves the names of submeshes back to where redo() took them from.
void SurfaceEditor::keep_names(Redo& redo) noexcept {
  for (std::size_t m = 0; m < redo.tails.meshes.size(); ++m) {
    auto& tail = redo.tails.meshes[m].submeshes;
    auto& of_mesh = character_.meshes[m].submeshes;
    std::move(of_mesh.end() - std::ssize(tail), of_mesh.end(), tail.begin());
  }
}

/// Makes room for everything that redo() appends.
void SurfaceEditor::make_room_for(const Redo& redo) {
  room.make_for_tails(redo.tails);
  for (Index m = 0; m < character_.meshes.size(); ++m) {
    const auto& records = redo.tails.edit.meshes[m].records;
    std::size_t vertices = 0, influences = 0;
    for (Index v = 0; v < records.size(); ++v)
      if (records[v].policy == WeightPolicy::exact) {
        ++vertices;
        influences += redo.tails.meshes[m].weights.of(v).size();
      }
    exact.reserve(m, vertices, influences);
  }
}

void SurfaceEditor::append_rows(Redo& redo) {
  ModelColumns all = all_columns();
  for (const Addition& addition : redo.tails.edit.additions)
    if (addition.kind == Addition::Kind::tear_sides) sides.add_to(addition.mesh);
  const auto append = [](const Column& column, auto&& values, auto&& tail) {
    if (column.is_kept) append_all(tail, values);
  };
  for_each_common_column(append, all, redo.tails);
  for (Index m = 0; m < all.meshes.size(); ++m) for_each_mesh_column(m, append, all, redo.tails);
}

void SurfaceEditor::redo(Redo& redo, ChangeRecord* change) {
  if (change != nullptr) describe_redo(redo, *this, *change);
  make_room_for(redo);
  append_rows(redo);  // from here on nothing allocates
  room.forget();

  // The remaining columns are recomputed.
  for (Index m = 0; m < columns_.meshes.size(); ++m) fillings.complete(m);
  columns_.newest_change.resize(surface().triangle_count(), kNone);
  origins.link_new_parts();
  const auto& changes = columns_.triangle_changes;
  for (std::size_t i = changes.size() - redo.tails.edit.triangle_changes.size(); i < changes.size();
       ++i)
    columns_.newest_change[changes[i].triangle] = static_cast<Index>(i);

  sides.set_next(redo.next_side);
  for (const TriangleChange& changed : redo.changed) log.restore(changed);
  for (const auto& [point, corner] : redo.known_corners)
    connectivity.set_point_corner(point, corner);
  for (const SideChange& side : redo.sides) sides.at(side.mesh, side.vertex) = side.side;
  for (Index m = 0; m < character_.meshes.size(); ++m)
    exact.update_from(m, character_.meshes[m].vertex_count() -
                             static_cast<Index>(redo.tails.edit.meshes[m].records.size()));
  stage.begin();
  redo.end = log.mark(sides.next(), 0);
}

}  // namespace sunder::tear
