#pragma once

#include <span>

#include "tear/surface/edit_columns.h"

namespace sunder::tear {

/// Which rows operations appended and which old triangles they changed, so that the surface can be
/// taken back to any earlier mark, bit for bit, and a change be described. Each triangle is logged
/// once per mark.
class EditLog {
 public:
  /// A state to come back to: how many rows there were.
  struct Mark {
    Index points = 0;
    Index triangles = 0;
    Index vertices = 0;  ///< Appended, over all meshes.
    Index additions = 0;
    Index kept_births = 0;
    Index next_side = 1;
    Index triangle_changes = 0;
    Index side_changes = 0;
  };

  EditLog(Character& character, EditColumns& columns)
      : character_(character), columns_(columns), mesh_rows_(character.meshes.size()) {}

  /// What was logged or appended before need not be logged again. O(1).
  Mark mark(Index next_side);
  /// To be called when a state was rolled back to.
  void set_mark(const Mark& mark) { newest_mark_ = mark; }

  /// Keeps a triangle that is about to change. There must be room.
  void keep(Index triangle) {
    if (triangle >= newest_mark_.triangles) return;
    const Index previous = columns_.newest_change[triangle];
    if (previous != kNone && previous >= newest_mark_.triangle_changes) return;
    append(triangle, previous);
  }
  /// A triangle as it is now.
  [[nodiscard]] TriangleChange describe(Index triangle) const;
  void restore(const TriangleChange& change);
  /// Restores the triangles that changed since, and forgets that they did.
  void restore_since(const Mark& mark);

  /// Rows appended since, over all meshes.
  [[nodiscard]] RowCounts rows_since(const Mark& mark) const;
  /// Rows per mesh. Valid until the next call.
  [[nodiscard]] std::span<const RowCounts> mesh_rows_since(const Mark& mark) const;
  [[nodiscard]] Index vertices_since(const Mark& mark) const {
    return static_cast<Index>(columns_.vertex_mesh.size()) - mark.vertices;
  }
  [[nodiscard]] std::span<const SideChange> side_changes_since(const Mark& mark) const {
    return std::span<const SideChange>(columns_.side_changes).subspan(mark.side_changes);
  }
  /// The number of vertices per mesh.
  [[nodiscard]] std::vector<Index> vertex_counts_at(const Mark& mark) const;

  /// Calls visit(TriangleChange) with the first change since of each triangle that was there at the
  /// mark, in the order in which they changed.
  template <class Visit>
  void for_each_first_change(const Mark& mark, Visit visit) const {
    const auto& changes = columns_.triangle_changes;
    for (Index i = mark.triangle_changes; i < changes.size(); ++i) {
      const Index previous = changes[i].previous;
      if (changes[i].triangle < mark.triangles &&
          (previous == kNone || previous < mark.triangle_changes))
        visit(changes[i]);
    }
  }
  /// Calls visit(triangle) for each of those triangles, retired ones too.
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
  /// Numbers the triangles that were changed or appended since, nearly without gaps; kNone for
  /// others.
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
