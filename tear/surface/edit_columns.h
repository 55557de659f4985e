#pragma once

#include <sunder/operation/weight_options.h>
#include <sunder/tear/change_record.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <vector>

#include "tear/internal/mesh_vertices.h"
#include "tear/internal/surface.h"

namespace sunder::tear {

/// A vertex of a mesh.
struct VertexRef {
  Index mesh = kNone, vertex = kNone;

  bool operator==(const VertexRef&) const = default;
};

/// Data of an appended vertex in addition to its birth.
struct VertexRecord {
  VertexRef original;  ///< The first vertex at the same point; itself if there was none before.
  /// Index in EditColumns::kept_births; kNone if the mesh has the values by birth.
  Index kept_birth = kNone;
  WeightPolicy policy = WeightPolicy::barycentric;
};

/// Position and influences by birth of a vertex that has other weights in its mesh.
struct KeptBirth {
  Vec3f position;
  Index first_influence, influence_count;  ///< Range in EditColumns::kept_influences.
};

/// A triangle as it was before a change, with the `point_corner` entries of its points.
struct TriangleChange {
  Index triangle;
  Index previous;  ///< The previous change of the same triangle; kNone if there is none.
  std::array<Index, 3> points;
  std::array<Index, 3> twins;
  std::array<Index, 3> point_corners;
  Triangle vertices;
};

/// A value of _TEARSIDE as it was before a change.
struct SideChange {
  Index mesh, vertex;
  float side;
};

/// Something that was added to a mesh in addition to vertices and triangles.
struct Addition {
  enum class Kind : std::uint8_t { filling, submesh, tear_sides } kind;
  Index mesh;
};

/// The fillings of a mesh that were made together: the walls of an operation, or the caps of one
/// side of a cut. Groups are numbered in the order of their first fillings.
struct FillingGroup {
  Index group;
  Index group_count;  ///< Groups up to this filling.
};

/// The columns of one mesh.
struct MeshColumns {
  std::vector<Birth> births;                   ///< Per appended vertex.
  std::vector<VertexRecord> records;           ///< Per appended vertex.
  std::vector<Index> surface_triangles;        ///< Per appended triangle: its index in the surface.
  std::vector<Triangle> fillings;              ///< Per triangle of a wall or cap, as it was made.
  std::vector<FillingGroup> filling_groups;    ///< Per filling.
  std::vector<std::uint64_t> filling_serials;  ///< Per filling.
  /// Per origin (triangles of the source, then fillings): its part that was appended last.
  std::vector<Index> newest_part;
  /// Index of _TEARSIDE in the mesh's custom attributes; kNone if it has none.
  Index tear_side = kNone;
  /// Memory for the values of _TEARSIDE while the mesh lacks it, all zero.
  std::vector<float> spare_sides;
};

/// Everything that operations append to, apart from the meshes of the character.
struct EditColumns {
  Surface surface;
  std::vector<MeshColumns> meshes;
  std::vector<Index> vertex_mesh;  ///< Per appended vertex, over all meshes.
  /// Per appended triangle: the one it was split from, see TriangleOrigins.
  std::vector<Index> parents;
  std::vector<Index> older_part;  ///< Per appended triangle: the part of the same origin before it.
  /// Per triangle: its last entry in triangle_changes; kNone if there is none.
  std::vector<Index> newest_change;
  std::vector<Index> ancestors;  ///< Per triangle of the stage, see Stage.
  std::vector<KeptBirth> kept_births;
  std::vector<Influence> kept_influences;
  std::vector<Addition> additions;
  /// Changes by all operations that are done and not undone.
  std::vector<TriangleChange> triangle_changes;
  std::vector<SideChange> side_changes;     ///< The same for _TEARSIDE.
  std::vector<std::array<Index, 2>> scars;  ///< The points of each edge that was welded.
  std::vector<SutureThread> threads;
};

/// The element that one row of a column describes.
enum class Rows : std::uint8_t {
  triangles,
  points,
  vertices,
  additions,
  kept_births,
  kept_influences,
  triangle_changes,
  side_changes,
  scars,
  threads,
  mesh_vertices,  // from here on per mesh
  mesh_triangles,
  mesh_fillings,
  mesh_submeshes
};

/// A count per kind of rows.
struct RowCounts {
  std::array<Index, static_cast<std::size_t>(Rows::mesh_submeshes) + 1> counts = {};

  [[nodiscard]] Index& operator[](Rows rows) { return counts[static_cast<std::size_t>(rows)]; }
  [[nodiscard]] Index operator[](Rows rows) const { return counts[static_cast<std::size_t>(rows)]; }
};

struct Column {
  Rows rows;
  Index per_row = 1;
  /// Whether undo keeps the rows for redo; redo recomputes those of other columns.
  bool is_kept = true;
};

/// The vertex arrays and weights of a mesh as one column.
template <class AnyMesh>
struct MeshVertices {
  AnyMesh& mesh;
};
template <class AnyMesh>
MeshVertices(AnyMesh&) -> MeshVertices<AnyMesh>;  // clang deduces it of no aggregate before 17

/// All columns of a model.
struct ModelColumns {
  EditColumns& edit;
  std::vector<Mesh>& meshes;
};

/// The last rows of all columns, as undo keeps them for redo.
struct ColumnTails {
  EditColumns edit;
  std::vector<Mesh> meshes;
};

// The table of columns. Room, roll back, undo and redo walk it: a new column is added here and
// nowhere else. `of` are objects with the same columns (ModelColumns, ColumnTails).

/// Calls visit(Column, values...) for each column that all meshes share.
template <class Visit, class... Tables>
void for_each_common_column(Visit visit, Tables&... of) {
  visit(Column{Rows::triangles, 3}, of.edit.surface.corner_point...);
  visit(Column{Rows::triangles, 3}, of.edit.surface.twin...);
  visit(Column{Rows::triangles}, of.edit.surface.appended...);
  visit(Column{Rows::triangles}, of.edit.parents...);
  visit(Column{Rows::triangles, 1, false}, of.edit.older_part...);
  visit(Column{Rows::triangles, 1, false}, of.edit.newest_change...);
  visit(Column{Rows::triangles, 1, false}, of.edit.ancestors...);
  visit(Column{Rows::points}, of.edit.surface.point_corner...);
  visit(Column{Rows::points}, of.edit.surface.appended_side...);
  visit(Column{Rows::vertices}, of.edit.vertex_mesh...);
  visit(Column{Rows::additions}, of.edit.additions...);
  visit(Column{Rows::kept_births}, of.edit.kept_births...);
  visit(Column{Rows::kept_influences}, of.edit.kept_influences...);
  visit(Column{Rows::triangle_changes}, of.edit.triangle_changes...);
  visit(Column{Rows::side_changes}, of.edit.side_changes...);
  visit(Column{Rows::scars}, of.edit.scars...);
  visit(Column{Rows::threads}, of.edit.threads...);
}

/// Calls visit(Column, values...) for each column of a mesh.
template <class Visit, class... Tables>
void for_each_mesh_column(Index mesh, Visit visit, Tables&... of) {
  visit(Column{Rows::mesh_vertices}, MeshVertices{of.meshes[mesh]}...);
  visit(Column{Rows::mesh_vertices}, of.edit.meshes[mesh].births...);
  visit(Column{Rows::mesh_vertices}, of.edit.meshes[mesh].records...);
  visit(Column{Rows::mesh_triangles}, of.meshes[mesh].triangles...);
  visit(Column{Rows::mesh_triangles}, of.meshes[mesh].triangle_submesh...);
  visit(Column{Rows::mesh_triangles}, of.edit.meshes[mesh].surface_triangles...);
  visit(Column{Rows::mesh_fillings}, of.edit.meshes[mesh].fillings...);
  visit(Column{Rows::mesh_fillings}, of.edit.meshes[mesh].filling_groups...);
  visit(Column{Rows::mesh_fillings, 1, false}, of.edit.meshes[mesh].filling_serials...);
  visit(Column{Rows::mesh_fillings, 1, false}, of.edit.meshes[mesh].newest_part...);
  visit(Column{Rows::mesh_submeshes}, of.meshes[mesh].submeshes...);
}

/// Removes the last `count` entries, at most all.
template <class Value>
void remove_last(std::size_t count, std::vector<Value>& values) {
  values.erase(values.end() - static_cast<std::ptrdiff_t>(std::min(count, values.size())),
               values.end());
}
inline void remove_last(std::size_t count, MeshVertices<Mesh> of) {
  if (count > 0) remove_vertices_from(of.mesh.vertex_count() - static_cast<Index>(count), of.mesh);
}

template <class Value>
void copy_last(std::size_t count, const std::vector<Value>& values, std::vector<Value>& tail) {
  tail.assign(values.end() - static_cast<std::ptrdiff_t>(count), values.end());
}
inline void copy_last(std::size_t count, MeshVertices<Mesh> of, MeshVertices<Mesh> tail) {
  copy_vertices_from(of.mesh.vertex_count() - static_cast<Index>(count), of.mesh, tail.mesh);
}

/// Moves the rows, because copies of names may need memory. There must be room.
template <class Value>
void append_all(std::vector<Value>& tail, std::vector<Value>& values) {
  values.insert(values.end(), std::make_move_iterator(tail.begin()),
                std::make_move_iterator(tail.end()));
}
inline void append_all(MeshVertices<Mesh> tail, MeshVertices<Mesh> of) {
  append_vertices(tail.mesh, of.mesh);
}

}  // namespace sunder::tear
