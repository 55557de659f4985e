#pragma once

#include <memory>

#include "tear/surface/edit_columns.h"
#include "tear/surface/surface_cells.h"

namespace sunder::tear {

/// The cells of a surface that no operation has changed. O(faces). @throws std::bad_alloc
[[nodiscard]] std::shared_ptr<const SurfaceCells> make_cells(const Surface& surface,
                                                             const Character& source);

/// The cells of a model's source that operations changed. The faces of a clean node are as they
/// were in the source, with the same neighbours.
class ChangedCells {
 public:
  ChangedCells(const Character& source, const EditColumns& columns)
      : source_(source), columns_(columns) {}

  /// Sets the cells of the source, which models share. To be called before any operation. @throws
  /// std::bad_alloc
  void share(std::shared_ptr<const SurfaceCells> cells);
  /// Takes in the changes since the last call. The first call also builds the cells, in O(faces),
  /// if none are shared.
  /// @throws std::bad_alloc before anything is changed
  void update();
  /// To be called before the log entries from `change` on are taken back.
  void forget_from(Index change) noexcept;
  /// Whether update() has nothing to do.
  [[nodiscard]] bool has_counted_all() const { return seen_ == columns_.triangle_changes.size(); }
  /// To be called if it had nothing to do before changes were dropped that count for nothing:
  /// those that are not the first one of a triangle of the source.
  void keep_all_counted() noexcept { seen_ = static_cast<Index>(columns_.triangle_changes.size()); }

  // After update():

  [[nodiscard]] const SurfaceCells& cells() const { return *cells_; }
  [[nodiscard]] bool is_clean(Index node) const { return changed_[node] == 0; }
  /// The largest clean node that contains a clean one.
  [[nodiscard]] Index top_clean(Index node) const {
    for (Index up = cells_->parent(node); up != kNone && is_clean(up); up = cells_->parent(up))
      node = up;
    return node;
  }
  /// Memory for a search: a value per node, kNone before and after it.
  [[nodiscard]] std::vector<Index>& marks() { return marks_; }

  [[nodiscard]] std::size_t bytes() const;

 private:
  [[nodiscard]] std::shared_ptr<const SurfaceCells> build() const;
  [[nodiscard]] bool is_first_of_source(const TriangleChange& change) const {
    return change.previous == kNone && change.triangle < columns_.surface.first_triangle.back();
  }
  void count(Index face);
  void discount(Index face) noexcept;

  const Character& source_;
  const EditColumns& columns_;
  std::shared_ptr<const SurfaceCells> cells_;
  std::vector<Index> changed_;  ///< Per node: its changed faces, or its changed children.
  std::vector<Index> marks_;
  Index seen_ = 0;  ///< Entries of the log that were taken in.
};

}  // namespace sunder::tear
