#pragma once

#include <sunder/tear/torn_model.h>

#include <algorithm>

#include "tear/surface/capacity_exceeded.h"
#include "tear/surface/edit_columns.h"

namespace sunder::tear {

/// Entries beyond `size` for which a column has room before the first operation.
[[nodiscard]] std::size_t entries_in_advance(const Column& column, std::size_t size,
                                             const TornCapacity& capacity, std::size_t mesh_count);
/// The same for the vertex arrays of a mesh and its influences.
[[nodiscard]] VertexRoom vertices_in_advance(const Mesh& mesh, const TornCapacity& capacity);

/// Reserves memory of the columns before a change begins, so that no change is left half done when
/// memory runs out. Columns of a model of fixed capacity do not grow.
///
/// All functions may throw CapacityExceeded or std::bad_alloc; the rows are unchanged then.
class Room {
 public:
  explicit Room(const ModelColumns& columns) : columns_(columns) {}

  /// Sets the capacity for operations and reserves memory for it.
  void reserve(const TornCapacity& capacity);
  [[nodiscard]] bool is_fixed() const { return is_fixed_; }

  /// Makes room for `count` vertices of a mesh with `influences` influences in all, and for as many
  /// points.
  void make_for_vertices(Index mesh, Index count, Index influences) {
    if (known_.vertices_of != mesh || known_.vertices < count || known_.influences < influences)
      find_for_vertices(mesh, count, influences);
    known_.vertices -= count;
    known_.influences -= influences;
    known_.points -= std::min<std::size_t>(known_.points, count);
  }
  void make_for_triangles(Index mesh, Index count) {
    if (known_.triangles_of != mesh || known_.triangles < count) find_for_triangles(mesh, count);
    known_.triangles -= count;
  }
  /// Makes room for entries of the edit log.
  void make_for_changes(std::size_t count) {
    auto& changes = columns_.edit.triangle_changes;
    if (changes.capacity() - changes.size() < count) grow(changes, count, "changes of triangles");
  }
  /// Makes room for a filling and a submesh.
  void make_for_additions(Index mesh) {
    if (known_.additions_of != mesh || known_.additions == 0) find_for_additions(mesh);
    --known_.additions;
  }
  /// Makes room for one more kept birth. It is not limited, because only policies keep births and
  /// the number of vertices is limited.
  void make_for_kept_birth(std::size_t influences);
  /// Makes room for welded edges, and for values of _TEARSIDE that change with them. Not limited,
  /// because a weld appends no elements.
  void make_for_welds(std::size_t edges, std::size_t side_changes);
  void make_for_threads(std::size_t count);
  void make_for_influences(Index mesh, std::size_t more);
  /// Makes room for a point without a vertex.
  void make_for_point() {
    if (known_.points == 0) find_for_point();
    --known_.points;
  }
  /// Makes room for the rows that undo kept, and for those that redo recomputes.
  void make_for_tails(const ColumnTails& tails);
  /// To be called after columns grew in another way.
  void forget() { known_ = {}; }

  /// Total number of influences of the corners of a triangle.
  [[nodiscard]] Index influence_count(Index mesh, const Triangle& of) const;

 private:
  /// A lower bound of the room: the room found last, minus the room requested since.
  struct Known {
    Index vertices_of = kNone, triangles_of = kNone, additions_of = kNone;  ///< The mesh.
    std::size_t vertices = 0, influences = 0, triangles = 0, additions = 0, points = 0;
  };

  void find_for_vertices(Index mesh, Index count, Index influences);
  void make_for_tear_sides(Index mesh, std::size_t count);
  void make_in_mesh(Index mesh, std::size_t count, std::size_t influences);
  void find_for_triangles(Index mesh, Index count);
  void find_for_additions(Index mesh);
  void find_for_point();
  template <class IsMeant>
  std::size_t make_in_columns(Index mesh, std::size_t count, const char* what, IsMeant is_meant);
  template <class Value>
  void grow(std::vector<Value>& values, std::size_t more, const char* what);

  ModelColumns columns_;
  Known known_;
  bool is_fixed_ = false;
};

}  // namespace sunder::tear
