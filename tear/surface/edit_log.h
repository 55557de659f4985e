#pragma once

#include <span>

#include "tear/surface/edit_columns.h"

namespace sunder::tear {

/// Logs the rows that operations appended and the old triangles that they changed, so that the
/// surface can be rolled back to any earlier mark, bit for bit, and changes can be described. Each
/// triangle is logged once per mark.
class EditLog {
 public:
  /// A state to which the surface can be rolled back: the row counts at that time.
  struct Mark {
    Index points = 0;
    Index triangles = 0;
    Index vertices = 0;  ///< Number of appended vertices, over all meshes.
    Index additions = 0;
    Index kept_births = 0;
    Index next_side = 1;
    Index triangle_changes = 0;
    Index side_changes = 0;
    Index opened_changes = 0;  ///< OpenedEdges::change_count().
    Index scars = 0;
    Index threads = 0;

    bool operator==(const Mark&) const = default;
  };

  /// How far the log has come. Reading it sets no mark.
  struct Extent {
    Index triangles = 0, triangle_changes = 0;
  };
  [[nodiscard]] Extent extent() const {
    return {columns_.surface.triangle_count(),
            static_cast<Index>(columns_.triangle_changes.size())};
  }

  EditLog(Character& character, EditColumns& columns)
      : character_(character), columns_(columns), mesh_rows_(character.meshes.size()) {}

  /// Sets a new mark. Triangles that were logged or appended earlier are logged again when they
  /// change. O(1).
  Mark mark(Index next_side, Index opened_changes);
  /// Sets the mark after a roll back.
  void set_mark(const Mark& mark) { newest_mark_ = mark; }

  /// Logs a triangle that is about to change. There must be room.
  void keep(Index triangle) {
    if (triangle >= newest_mark_.triangles) return;
    const Index previous = columns_.newest_change[triangle];
    if (previous != kNone && previous >= newest_mark_.triangle_changes) return;
    append(triangle, previous);
  }
  /// The current state of a triangle.
  [[nodiscard]] TriangleChange describe(Index triangle) const;
  /// The twin of a half-edge before any operation changed its triangle. O(operations that did).
  [[nodiscard]] Index first_twin(Index half_edge) const;
  /// A triangle as it was at an earlier time; null: as it is now. O(operations that changed it).
  [[nodiscard]] const TriangleChange* former(Index triangle, const Extent& at) const {
    const TriangleChange* result = nullptr;
    for (Index i = columns_.newest_change[triangle]; i != kNone && i >= at.triangle_changes;
         i = result->previous)
      result = &columns_.triangle_changes[i];
    return result;
  }
  /// Calls visit(index) for the changes of a triangle, as Extent counts them, the newest first.
  template <class Visit>
  void for_each_change_of(Index triangle, Visit visit) const {
    for (Index i = columns_.newest_change[triangle]; i != kNone;
         i = columns_.triangle_changes[i].previous)
      visit(i);
  }
  /// Calls visit(triangle) for each triangle of the source that is not as it was loaded, and for
  /// each appended one.
  template <class Visit>
  void for_each_ever_changed(Visit visit) const {
    const Index of_source = columns_.surface.first_triangle.back();
    const auto& changes = columns_.triangle_changes;
    for (Index i = 0; i < changes.size(); ++i)
      if (changes[i].triangle < of_source && columns_.newest_change[changes[i].triangle] == i)
        visit(changes[i].triangle);
    for (Index t = of_source; t < columns_.surface.triangle_count(); ++t) visit(t);
  }
  void restore(const TriangleChange& change);
  /// Drops the entries of an operation that is complete, apart from the first one of each triangle
  /// that existed before it: only marks inside the operation need the others.
  void drop_inner_changes(const Mark& begin);
  /// Restores the triangles that changed since a mark, and removes their entries.
  void restore_since(const Mark& mark);

  /// Number of rows appended since a mark, over all meshes.
  [[nodiscard]] RowCounts rows_since(const Mark& mark) const;
  /// The same per mesh. Valid until the next call.
  [[nodiscard]] std::span<const RowCounts> mesh_rows_since(const Mark& mark) const;
  [[nodiscard]] Index vertices_since(const Mark& mark) const {
    return static_cast<Index>(columns_.vertex_mesh.size()) - mark.vertices;
  }
  [[nodiscard]] std::span<const SideChange> side_changes_since(const Mark& mark) const {
    return std::span<const SideChange>(columns_.side_changes).subspan(mark.side_changes);
  }
  /// Number of vertices per mesh at a mark.
  [[nodiscard]] std::vector<Index> vertex_counts_at(const Mark& mark) const;

  /// Calls visit(TriangleChange) with the first change since a mark of each triangle that existed
  /// at the mark, in the order of the changes.
  template <class Visit>
  void for_each_first_change(const Mark& mark, Visit visit) const {
    for_each_first_change(mark, extent(), visit);
  }
  /// The same for the changes before `end`.
  template <class Visit>
  void for_each_first_change(const Mark& mark, const Extent& end, Visit visit) const {
    const auto& changes = columns_.triangle_changes;
    for (Index i = mark.triangle_changes; i < end.triangle_changes; ++i) {
      const Index previous = changes[i].previous;
      if (changes[i].triangle < mark.triangles &&
          (previous == kNone || previous < mark.triangle_changes))
        visit(changes[i]);
    }
  }
  /// Calls visit(triangle) for each of those triangles, including retired ones.
  template <class Visit>
  void for_each_changed(const Mark& mark, Visit visit) const {
    for_each_first_change(mark, [&](const TriangleChange& change) { visit(change.triangle); });
  }
  /// Calls visit(triangle, neighbour) for the neighbours that those triangles had at the mark.
  template <class Visit>
  void for_each_former_neighbour(const Mark& mark, Visit visit) const {
    for_each_first_change(mark, [&](const TriangleChange& change) {
      for (const Index twin : change.twins)
        if (twin != kNone) visit(change.triangle, twin / 3);
    });
  }
  /// Numbers the triangles that were changed or appended since a mark, nearly without gaps; kNone
  /// for others.
  [[nodiscard]] Index number_since(const Mark& mark, Index triangle) const {
    const Index changes =
        static_cast<Index>(columns_.triangle_changes.size()) - mark.triangle_changes;
    if (triangle >= mark.triangles) return changes + triangle - mark.triangles;
    const Index change = columns_.newest_change[triangle];
    return change == kNone || change < mark.triangle_changes ? kNone
                                                             : change - mark.triangle_changes;
  }
  /// Upper bound of those numbers; 0 if nothing changed.
  [[nodiscard]] Index numbers_since(const Mark& mark) const {
    return static_cast<Index>(columns_.triangle_changes.size()) - mark.triangle_changes +
           columns_.surface.triangle_count() - mark.triangles;
  }

 private:
  void append(Index triangle, Index previous);

  Character& character_;
  EditColumns& columns_;
  Mark newest_mark_;
  mutable std::vector<RowCounts> mesh_rows_;
};

}  // namespace sunder::tear
