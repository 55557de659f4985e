#pragma once

#include <sunder/skinning/pose.h>

#include <cstdint>
#include <vector>

namespace sunder::tools {

/// A vertex of a character.
struct MeshVertex {
  std::uint32_t mesh = 0, vertex = 0;
  bool operator==(const MeshVertex&) const = default;
};

/// Vertices that stand at the same place and follow the same bones by the same weights, bit for
/// bit, as the copies of a point along a seam or a torn lip. If their weights are changed alike,
/// they stay together in every pose.
class CoincidentVertices {
 public:
  /// @param takes_part  one per mesh; vertices of the others coincide with none.
  /// O(n log n) for n influences, allocates.
  CoincidentVertices(const Character& character, const ModelPose& bind,
                     const std::vector<bool>& takes_part);

  /// The first vertex that coincides with a vertex, which may be itself.
  [[nodiscard]] MeshVertex first_like(std::uint32_t mesh, std::uint32_t vertex) const {
    return first_[mesh][vertex];
  }
  /// Meshes that are joined by coincident vertices, ascending; a mesh that takes part stands in
  /// exactly one list.
  [[nodiscard]] const std::vector<std::vector<std::uint32_t>>& joined_meshes() const {
    return joined_;
  }

 private:
  std::vector<std::vector<MeshVertex>> first_;  // per mesh and vertex
  std::vector<std::vector<std::uint32_t>> joined_;
};

}  // namespace sunder::tools
