#pragma once

#include <sunder/core/character.h>
#include <sunder/tear/change_record.h>
#include <sunder/tear/torn_model.h>

#include "tear/surface/births.h"
#include "tear/surface/connectivity.h"
#include "tear/surface/edit_columns.h"
#include "tear/surface/edit_log.h"
#include "tear/surface/exact_positions.h"
#include "tear/surface/fillings.h"
#include "tear/surface/opened_edges.h"
#include "tear/surface/room.h"
#include "tear/surface/scratch_memory.h"
#include "tear/surface/stage.h"
#include "tear/surface/tear_sides.h"
#include "tear/surface/triangle_origins.h"

namespace sunder::tear {

/// The surface of a model that is torn, with its meshes, and all that is known of what was done to
/// it. Functions of this folder that take a SurfaceEditor are the only ones that change either;
/// every change is logged, so that it can be taken back to any earlier mark, bit for bit.
class SurfaceEditor {
 public:
  SurfaceEditor(const Character& source, Character& character);
  SurfaceEditor(const SurfaceEditor&) = delete;
  SurfaceEditor& operator=(const SurfaceEditor&) = delete;

  [[nodiscard]] const Surface& surface() const { return columns_.surface; }
  [[nodiscard]] const Character& character() const { return character_; }
  [[nodiscard]] const Character& source() const { return source_; }
  /// For what lives no longer than the operation under way.
  [[nodiscard]] ScratchMemory& scratch() const { return scratch_; }

  [[nodiscard]] Index vertex_at(Index corner) const { return connectivity.vertex_at(corner); }
  [[nodiscard]] bool is_source_vertex(Index corner) const {
    return vertex_at(corner) < source_.meshes[surface().triangle(corner / 3).mesh].vertex_count();
  }
  /// Barycentric coordinates of a corner in the triangle's origin.
  [[nodiscard]] std::array<double, 3> source_barycentric(Index corner) const {
    return births.place_in_origin(surface().triangle(corner / 3), vertex_at(corner));
  }
  /// Prefetches what crossing a face will read.
  void fetch(Index triangle) const;
  /// A mesh, to change weights or vertices that no one has seen yet.
  [[nodiscard]] Mesh& mutable_mesh(Index mesh) { return character_.meshes[mesh]; }

  // ---- Operations.

  /// Sets how much operations may append.
  void reserve(const TornCapacity& capacity);
  /// Changes are logged once from here on, so that any mark can be rolled back to. O(1).
  [[nodiscard]] EditLog::Mark mark() { return log.mark(sides.next()); }
  void roll_back(const EditLog::Mark& to);
  /// Takes back the newest operation, which began at `begin`.
  /// @param redo  written: what does it again. @param change  written, but for lips and rims.
  struct Redo;
  void undo(const EditLog::Mark& begin, Redo& redo, ChangeRecord& change);
  /// Does an operation again. @param change  written, but for lips and rims.
  void redo(const Redo& redo, ChangeRecord& change);

 private:
  [[nodiscard]] ModelColumns all_columns() { return {columns_, character_.meshes}; }
  void keep_rows(const EditLog::Mark& begin, Redo& redo);
  void keep_changes(const EditLog::Mark& begin, Redo& redo);
  void append_rows(const Redo& redo);

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
  Connectivity connectivity;
};

/// How undo was done: everything that redo needs.
struct SurfaceEditor::Redo {
  ColumnTails tails;
  Index next_side = 1;
  std::vector<TriangleChange> changed;  ///< Old triangles as the operation left them, ascending.
  std::vector<std::array<Index, 2>>
      known_corners;  ///< Old points, and the corners by which the operation left them known.
  std::vector<SideChange> sides;  ///< Values of _TEARSIDE as the operation left them.
};

}  // namespace sunder::tear
