#pragma once

#include <sunder/core/character.h>
#include <sunder/tear/change_record.h>
#include <sunder/tear/torn_model.h>

#include <optional>

#include "tear/surface/births.h"
#include "tear/surface/changed_cells.h"
#include "tear/surface/connectivity.h"
#include "tear/surface/edit_columns.h"
#include "tear/surface/edit_log.h"
#include "tear/surface/exact_positions.h"
#include "tear/surface/fillings.h"
#include "tear/surface/memory_use.h"
#include "tear/surface/opened_edges.h"
#include "tear/surface/room.h"
#include "tear/surface/scratch_memory.h"
#include "tear/surface/stage.h"
#include "tear/surface/tear_sides.h"
#include "tear/surface/triangle_origins.h"

namespace sunder::tear {

/// The surface and the meshes of a torn model, and the data about past operations. Only functions
/// of this folder that take a SurfaceEditor change them. Every change is logged, so that it can be
/// rolled back to any earlier mark, bit for bit.
class SurfaceEditor {
 public:
  SurfaceEditor(const Character& source, Character& character)
      : SurfaceEditor(source, character, build_surface(source)) {}
  /// @param surface   of the source, as build_surface() makes it.
  /// @param capacity  for which reserve() is going to be called.
  SurfaceEditor(const Character& source, Character& character, Surface surface,
                const TornCapacity& capacity = {});
  SurfaceEditor(const SurfaceEditor&) = delete;
  SurfaceEditor& operator=(const SurfaceEditor&) = delete;

  [[nodiscard]] const Surface& surface() const { return columns_.surface; }
  [[nodiscard]] const Character& character() const { return character_; }
  [[nodiscard]] const Character& source() const { return source_; }
  /// Memory for data that lives no longer than the operation under way.
  [[nodiscard]] ScratchMemory& scratch() const { return scratch_; }

  [[nodiscard]] Index vertex_at(Index corner) const { return connectivity.vertex_at(corner); }
  [[nodiscard]] VertexRef vertex_ref_at(Index corner) const {
    return {surface().triangle(corner / 3).mesh, vertex_at(corner)};
  }
  [[nodiscard]] bool is_wall(Index face) const {
    return fillings.is_wall(surface().triangle(face));
  }
  [[nodiscard]] bool is_source_vertex(Index corner) const {
    return vertex_at(corner) < source_.meshes[surface().triangle(corner / 3).mesh].vertex_count();
  }
  /// Barycentric coordinates of a corner in the triangle's origin.
  [[nodiscard]] std::array<double, 3> source_barycentric(Index corner) const {
    return births.place_in_origin(surface().triangle(corner / 3), vertex_at(corner));
  }
  /// Prefetches the data that crossing a face will read.
  void fetch(Index triangle) const;
  /// A mesh, for changes of weights and of vertices that were just appended.
  [[nodiscard]] Mesh& mutable_mesh(Index mesh) { return character_.meshes[mesh]; }

  // ---- Operations.

  /// Sets the capacity for operations.
  void reserve(const TornCapacity& capacity);
  /// Sets a mark to which the surface can be rolled back. O(1).
  [[nodiscard]] EditLog::Mark mark() { return log.mark(sides.next(), opened_edges.change_count()); }
  /// To be called when the operation that began at a mark is complete: marks set since are void.
  /// Does not allocate. O(changed triangles).
  void drop_inner_changes(const EditLog::Mark& begin) noexcept;
  /// Restores the state at a mark. Does not allocate.
  void roll_back(const EditLog::Mark& to) noexcept;
  struct Redo;
  /// Reverts the most recent operation, which began at `begin`. Does not allocate without `change`
  /// if the operation is as redo() left it, or `redo` has held as much before.
  /// @param redo    written: the input of redo().
  /// @param change  optional; written, except lips and rims.
  /// @throws std::bad_alloc before anything is changed
  void undo(const EditLog::Mark& begin, Redo& redo, ChangeRecord* change);
  /// Reapplies an operation. Does not allocate without `change` if nothing was changed since
  /// undo().
  /// @param change  optional; written, except lips and rims.
  /// @throws std::bad_alloc before anything is changed
  void redo(Redo& redo, ChangeRecord* change);
  void add_to(MemoryUse& use) const;

 private:
  [[nodiscard]] ModelColumns all_columns() { return {columns_, character_.meshes}; }
  void keep_rows(const EditLog::Mark& begin, Redo& redo);
  void keep_changes(const EditLog::Mark& begin, Redo& redo);
  void make_room_for(const Redo& redo);
  void append_rows(Redo& redo);
  void keep_names(Redo& redo) noexcept;

  const Character& source_;
  Character& character_;
  EditColumns columns_;
  mutable ScratchMemory scratch_;

 public:
  Room room;
  Fillings fillings;
  Births births;
  ExactPositions exact;
  TriangleOrigins origins;
  TearSides sides;
  Stage stage;
  OpenedEdges opened_edges;
  EditLog log;
  mutable ChangedCells changed_cells;  ///< Known when a search asks.
  Connectivity connectivity;
};

/// The data that undo keeps for redo.
struct SurfaceEditor::Redo {
  ColumnTails tails;
  Index next_side = 1;
  std::vector<TriangleChange> changed;  ///< Old triangles as the operation left them, ascending.
  /// Old points, with their `point_corner` as the operation left it.
  std::vector<std::array<Index, 2>> known_corners;
  std::vector<SideChange> sides;  ///< Values of _TEARSIDE as the operation left them.
  /// The state that redo() restored. While nothing was appended to it, the rest is up to date.
  std::optional<EditLog::Mark> end;

  /// Forgets the state; undo() then keeps another one in the same memory.
  void clear();
  /// Removes duplicates and unused memory.
  void shrink() noexcept;
  void add_to(MemoryUse& use) const;
};

}  // namespace sunder::tear
