#pragma once

#include <sunder/core/mesh.h>
#include <sunder/skinning/vertex_arrays.h>

namespace sunder::scene {

/// The vertices that tears appended to a mesh, as a source for skinning. The vertices of the
/// source are skinned by the asset, which all instances share.
class TornTail {
 public:
  /// @param first  the number of vertices of the source.
  explicit TornTail(Index first) : first_(first) {}

  /// Reads the appended vertices from `first_changed` on. O(their number). @throws std::bad_alloc
  void update(const Mesh& mesh, const InfluencePositions& exact, Index first_changed);
  /// Valid until the next update() and while the mesh is unchanged.
  [[nodiscard]] VertexSource source(const Mesh& mesh) const;

 private:
  Index first_;
  SkinWeights weights_;
  std::vector<MorphTarget> morph_targets_;
  InfluencePositions exact_;
};

}  // namespace sunder::scene
