#pragma once

#include <algorithm>

#include "tear/surface/births.h"

namespace sunder::tear {

/// The bind positions, one per influence, of the vertices of WeightPolicy::exact of each mesh.
class ExactPositions {
 public:
  ExactPositions(const Character& source, const Character& character, const EditColumns& columns,
                 const Births& births, const Fillings& fillings)
      : source_(source),
        character_(character),
        columns_(columns),
        births_(births),
        fillings_(fillings),
        exact_(character.meshes.size()),
        first_(character.meshes.size()) {}

  [[nodiscard]] const InfluencePositions& of(Index mesh) const { return exact_[mesh]; }
  /// Index of the first position of an exact vertex among those of its mesh.
  [[nodiscard]] std::size_t place(Index mesh, Index vertex) const {
    const auto& vertices = exact_[mesh].vertices;
    return first_[mesh][static_cast<std::size_t>(
        std::lower_bound(vertices.begin(), vertices.end(), vertex) - vertices.begin())];
  }
  [[nodiscard]] bool is_empty() const {
    return std::all_of(exact_.begin(), exact_.end(),
                       [](const InfluencePositions& of) { return of.vertices.empty(); });
  }

  /// Updates the positions of the vertices from `first` on. O(exact vertices from there).
  void update_from(Index mesh, Index first);
  /// Removes the positions of the vertices from `first` on; the vertices still exist.
  void forget_from(Index mesh, Index first);
  /// Reserves memory, so that an exchange of weights is not left half done when memory runs out.
  void reserve(Index mesh, std::size_t vertices, std::size_t influences);

 private:
  void append(Index mesh, Index vertex);
  template <class Value>
  [[nodiscard]] Eigen::Vector3d moved_by(Index slot, const VertexRef& vertex, bool follows_original,
                                         Value value) const;

  const Character& source_;
  const Character& character_;
  const EditColumns& columns_;
  const Births& births_;
  const Fillings& fillings_;
  std::vector<InfluencePositions> exact_;  ///< Per mesh.
  /// Per mesh, per exact vertex: index of its first position.
  std::vector<std::vector<Index>> first_;
};

}  // namespace sunder::tear
