#pragma once

#include <sunder/core/index.h>

#include <span>
#include <vector>

namespace sunder::tear {

/// The faces of an untorn surface in cells, cells of cells, and so on. The faces of a cell are
/// connected to one another across edges within the cell. A search over the surface can therefore
/// visit a cell in place of its faces where nothing has changed. Constant after it was built, so
/// that several models can share one.
///
/// A node is a cell of any level; the cells of faces come first. The topmost node of a part of the
/// surface has no neighbours. About 13 bytes per face.
class SurfaceCells {
 public:
  static constexpr Index kMostFaces = 32;     ///< Of a cell.
  static constexpr Index kMostChildren = 12;  ///< Of a cell of cells.

  SurfaceCells() = default;
  /// @param twin  three per face: the opposite half-edge, kNone at a border.
  /// @param area  one per face. O(faces).
  SurfaceCells(std::span<const Index> twin, std::span<const float> area);

  [[nodiscard]] Index face_count() const { return static_cast<Index>(rank_.size()); }
  [[nodiscard]] Index node_count() const { return static_cast<Index>(parent_.size()); }
  [[nodiscard]] bool is_of_faces(Index node) const { return node < cell_count_; }

  /// The cell of a face, and the place of the face in it.
  [[nodiscard]] Index cell_of(Index face) const { return rank_[face] / kMostFaces; }
  [[nodiscard]] Index place_of(Index face) const { return rank_[face] % kMostFaces; }
  [[nodiscard]] std::span<const Index> faces(Index cell) const {
    return part(faces_, first_face_, cell);
  }
  /// The nodes that a cell of cells consists of.
  [[nodiscard]] std::span<const Index> children(Index node) const {
    return part(children_, first_child_, node - cell_count_);
  }
  /// The nodes of the same level across edges.
  [[nodiscard]] std::span<const Index> neighbours(Index node) const {
    return part(neighbours_, first_neighbour_, node);
  }
  /// kNone for a topmost node.
  [[nodiscard]] Index parent(Index node) const { return parent_[node]; }
  [[nodiscard]] Index face_count(Index node) const { return face_counts_[node]; }
  [[nodiscard]] double area(Index node) const { return static_cast<double>(area_[node]); }

  [[nodiscard]] std::size_t bytes() const;

 private:
  class Builder;

  static std::span<const Index> part(const std::vector<Index>& of, const std::vector<Index>& first,
                                     std::size_t i) {
    return std::span(of).subspan(first[i], first[i + 1] - first[i]);
  }

  Index cell_count_ = 0;     ///< Cells of faces.
  std::vector<Index> rank_;  ///< Per face: kMostFaces x its cell + its place in it.
  std::vector<Index> faces_, first_face_;
  std::vector<Index> children_, first_child_;  ///< Of the nodes above the cells of faces.
  std::vector<Index> neighbours_, first_neighbour_;
  std::vector<Index> parent_, face_counts_;
  std::vector<float> area_;  ///< Per node.
};

}  // namespace sunder::tear
