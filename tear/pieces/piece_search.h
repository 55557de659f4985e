#pragma once

#include "tear/surface/changed_cells.h"
#include "tear/surface/disjoint_sets.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Fronts that grow over the surface and are merged where they meet. They cross clean cells of the
/// source as a whole, so the cost depends on the faces near changes and hardly on the size of the
/// surface.
class PieceSearch {
 public:
  PieceSearch(Index front_count, const SurfaceEditor& editor);
  ~PieceSearch();
  PieceSearch(const PieceSearch&) = delete;
  PieceSearch& operator=(const PieceSearch&) = delete;

  /// Lets a front start at a live face.
  void begin_at(Index front, Index face) { reach_face(front, face); }
  /// Notes that two fronts were connected before the operation.
  void were_connected(Index a, Index b) { groups_.unite(groups_.find(a), groups_.find(b)); }

  /// Grows the fronts in turn until at most one part is not known completely.
  void grow();

  /// A part of a former component that now has several.
  struct Part {
    Index front;           ///< The least of its fronts.
    Index component;       ///< Numbered from 0.
    Index triangle_count;  ///< kNone if it is not known.
    /// The largest part, in bind space, of the former component; of equal ones the first.
    bool is_body;
  };
  /// Ascending by front.
  [[nodiscard]] ScratchVector<Part> separated();

 private:
  /// Faces that are visited one by one, and clean nodes (with kNode).
  struct Front {
    explicit Front(ScratchMemory& scratch) : open(&scratch), at_change(&scratch), faces(&scratch) {}
    ScratchVector<Index> open;  ///< Visited, but their neighbours are not.
    ScratchVector<Index>
        at_change;               ///< Clean nodes of which only changed neighbours are not visited.
    ScratchVector<Index> faces;  ///< All visited.
    std::size_t measured = 0;    ///< Number of faces whose areas were added.
    Index triangles = 0;
    double area = 0;  ///< Of clean nodes and measured faces, in bind space.
    Index least = kNone;
  };
  static constexpr Index kNode = Index{1} << 31;
  static constexpr std::size_t kStepsATurn = 16, kFacesAtATime = 64;

  [[nodiscard]] bool is_active(Index front) const {
    return !fronts_[front].open.empty() || !fronts_[front].at_change.empty();
  }
  [[nodiscard]] Index first_mark_of(Index cell);
  /// Prefetches the neighbours of the faces of a cell.
  void fetch_faces(Index cell) const;
  /// Adds the area of an appended face, or a bound of it, to area_of_faces_.
  void bound_area_of(Index appended);
  void reach_face(Index front, Index face);
  void visit_face(Index front, Index face, Index& mark);
  void reach_node(Index front, Index node);
  void step(Index front);
  [[nodiscard]] bool has_visited(Index front, Index face) const;
  void leave_face(Index front, Index face);
  void leave_node(Index front, Index node);
  void enter_changed_cells(Index front, Index node);
  /// Whether all faces of the changed cells next to a clean one were left, so that it is known
  /// which front each of them belongs to.
  [[nodiscard]] bool are_neighbours_left(Index cell) const;
  void join(Index a, Index b);
  void find_active();
  /// Adds the areas of so many visited faces.
  void measure(Front& front, std::size_t most_faces = kNone);
  [[nodiscard]] double area_of(Index face) const;
  [[nodiscard]] Index largest_of(std::span<const Index> parts) const;
  [[nodiscard]] Index measure_until_clear(std::span<const Index> parts);
  [[nodiscard]] Index find_body(std::span<const Index> parts);

  const SurfaceEditor& editor_;
  const Surface& surface_;
  ChangedCells& changed_cells_;
  const SurfaceCells& cells_;
  ScratchMemory& scratch_;
  DisjointSets sets_, groups_;
  ScratchVector<Front> fronts_;
  /// Clean nodes that were visited, and changed cells that have marks of faces.
  ScratchVector<Index> marked_nodes_;
  /// Per such cell: the number of its faces that were not left, then a mark per face.
  ScratchVector<Index> cell_marks_;
  ScratchVector<Index> appended_marks_;  ///< Per appended triangle.
  ScratchVector<Index> active_;          ///< The fronts that can still grow.
  /// Upper bound of the areas of visited faces; unknown once a front is in a wall or cap.
  double area_of_faces_ = 0;
};

}  // namespace sunder::tear
