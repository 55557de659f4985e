#pragma once

#include <sunder/tear/torn_model.h>

#include "tear/surface/capacity_exceeded.h"
#include "tear/surface/edit_columns.h"

namespace sunder::tear {

/// Lets columns grow before a change begins, so that none is left half done for want of memory.
/// Columns of a model of fixed capacity do not grow.
///
/// All functions throw CapacityExceeded or std::bad_alloc; rows are as they were then.
class Room {
 public:
  explicit Room(const ModelColumns& columns) : columns_(columns) {}

  /// Sets how much operations may append, and gives the columns room for it.
  void reserve(const TornCapacity& capacity);
  [[nodiscard]] bool is_fixed() const { return is_fixed_; }

  /// For `count` vertices of a mesh with `influences` influences in all, and for as many points.
  void make_for_vertices(Index mesh, Index count, Index influences) {
    if (known_.vertices_of != mesh || known_.vertices < count || known_.influences < influences)
      find_for_vertices(mesh, count, influences);
    known_.vertices -= count;
    known_.influences -= influences;
  }
  void make_for_triangles(Index mesh, Index count) {
    if (known_.triangles_of != mesh || known_.triangles < count) find_for_triangles(mesh, count);
    known_.triangles -= count;
  }
  /// For entries of the edit log.
  void make_for_changes(std::size_t count) {
    auto& changes = columns_.edit.triangle_changes;
    if (changes.capacity() - changes.size() < count) grow(changes, count, "changes of triangles");
  }
  /// For a filling and a submesh.
  void make_for_additions(Index mesh);
  /// For one more kept birth. Not limited: policies alone keep births, and the number of vertices
  /// is limited.
  void make_for_kept_birth(std::size_t influences);
  void make_for_influences(Index mesh, std::size_t more);
  /// To be called after columns grew in another way.
  void forget() { known_ = {}; }

  /// Influences of the corners of a triangle, in all.
  [[nodiscard]] Index influence_count(Index mesh, const Triangle& of) const;

 private:
  /// The room found last, less what was asked for since: there is at least that much.
  struct Known {
    Index vertices_of = kNone, triangles_of = kNone;  ///< Mesh.
    std::size_t vertices = 0, influences = 0, triangles = 0;
  };

  void find_for_vertices(Index mesh, Index count, Index influences);
  void find_for_triangles(Index mesh, Index count);
  template <class IsMeant>
  std::size_t make_in_columns(Index mesh, std::size_t count, const char* what, IsMeant is_meant);
  template <class Value>
  void grow(std::vector<Value>& values, std::size_t more, const char* what);

  ModelColumns columns_;
  Known known_;
  bool is_fixed_ = false;
};

}  // namespace sunder::tear
