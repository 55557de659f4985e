#include "tear/surface/surface_editor.h"

#include "core/internal/prefetch.h"

namespace sunder::tear {
namespace {

/// Memory for the work of one operation for which a model of fixed capacity reserves memory, bytes:
/// at least, and for each triangle of its capacity. An operation that needs more allocates.
constexpr std::size_t kLeastScratch = std::size_t{1} << 19;
constexpr std::size_t kScratchPerTriangle = 8;

EditColumns columns_of(const Character& character, Surface surface, const TornCapacity& capacity) {
  const auto assign = [&](const Column& column, std::size_t count, std::vector<Index>& values) {
    values.reserve(count + entries_in_advance(column, count, capacity, character.meshes.size()));
    values.assign(count, kNone);
  };
  EditColumns columns;
  columns.surface = std::move(surface);
  columns.meshes.resize(character.meshes.size());
  assign({Rows::triangles}, columns.surface.triangle_count(), columns.newest_change);
  for (std::size_t m = 0; m < columns.meshes.size(); ++m)
    assign({Rows::mesh_fillings}, character.meshes[m].triangle_count(),
           columns.meshes[m].newest_part);
  return columns;
}

}  // namespace

SurfaceEditor::SurfaceEditor(const Character& source, Character& character, Surface surface,
                             const TornCapacity& capacity)
    : source_(source),
      character_(character),
      columns_(columns_of(character, std::move(surface), capacity)),
      room(all_columns()),
      fillings(source, character, columns_),
      births(source, character, columns_, fillings, room, scratch_),
      exact(source, character, columns_, births, fillings),
      origins(source, character, columns_),
      sides(character, columns_),
      stage(columns_),
      opened_edges(columns_.surface),
      log(character, columns_),
      changed_cells(source, columns_),
      connectivity(character, columns_, origins, sides, stage) {}

void SurfaceEditor::fetch(Index triangle) const {
  prefetch(&columns_.surface.corner_point[3 * std::size_t{triangle}]);
  prefetch(&columns_.surface.twin[3 * std::size_t{triangle}]);
  prefetch(&columns_.newest_change[triangle]);
  if (triangle >= columns_.surface.first_triangle.back()) return;
  const TriangleRef ref = columns_.surface.triangle(triangle);
  prefetch(&character_.meshes[ref.mesh].triangles[ref.triangle]);
  prefetch(&character_.meshes[ref.mesh].triangle_submesh[ref.triangle]);
  prefetch(&source_.meshes[ref.mesh].triangles[ref.triangle]);
  origins.fetch_newest_part(ref);
}

void SurfaceEditor::reserve(const TornCapacity& capacity) {
  sides.reserve();
  room.reserve(capacity);
  if (room.is_fixed()) scratch_.reserve(kScratchPerTriangle * capacity.triangles + kLeastScratch);
  if (room.is_fixed()) changed_cells.update();
}

void SurfaceEditor::drop_inner_changes(const EditLog::Mark& begin) noexcept {
  const bool has_counted = changed_cells.has_counted_all();
  if (!has_counted) changed_cells.forget_from(begin.triangle_changes);
  log.drop_inner_changes(begin);
  if (has_counted) changed_cells.keep_all_counted();
  (void)mark();
}

void SurfaceEditor::roll_back(const EditLog::Mark& to) noexcept {
  changed_cells.forget_from(to.triangle_changes);
  log.restore_since(to);
  auto& side_changes = columns_.side_changes;
  for (; side_changes.size() > to.side_changes; side_changes.pop_back())
    sides.at(side_changes.back().mesh, side_changes.back().vertex) = side_changes.back().side;
  origins.unlink_parts_from(to.triangles);
  const RowCounts rows = log.rows_since(to);
  const std::span<const RowCounts> mesh_rows = log.mesh_rows_since(to);
  ModelColumns all = all_columns();
  for (Index m = 0; m < all.meshes.size(); ++m) {
    exact.forget_from(m, all.meshes[m].vertex_count() - mesh_rows[m][Rows::mesh_vertices]);
    for_each_mesh_column(
        m,
        [&](const Column& column, auto&& values) {
          remove_last(column.per_row * mesh_rows[m][column.rows], values);
        },
        all);
  }
  // The attribute goes after the values of new vertices, so that all that is kept of it is zero.
  for (std::size_t i = columns_.additions.size(); i > to.additions; --i)
    if (columns_.additions[i - 1].kind == Addition::Kind::tear_sides)
      sides.remove_from(columns_.additions[i - 1].mesh);
  for_each_common_column(
      [&](const Column& column, auto&& values) {
        remove_last(column.per_row * rows[column.rows], values);
      },
      all);
  opened_edges.roll_back(to.opened_changes);
  sides.set_next(to.next_side);
  log.set_mark(to);
  stage.roll_back(to.triangles);
}

}  // namespace sunder::tear
