#pragma once

#include <sunder/core/mesh.h>
#include <sunder/scene/character_asset.h>

#include <span>
#include <vector>

namespace sunder::scene {

/// The order in which a mesh without tears is drawn: its triangles, grouped by submesh.
class DrawOrder {
 public:
  explicit DrawOrder(const Mesh& mesh);

  [[nodiscard]] std::span<const Triangle> triangles(const Mesh& mesh) const {
    return grouped_.empty() ? std::span<const Triangle>(mesh.triangles) : grouped_;
  }
  /// The place of a triangle of the mesh in the index buffer.
  [[nodiscard]] Index place(Index triangle) const {
    return places_.empty() ? triangle : places_[triangle];
  }
  [[nodiscard]] std::span<const DrawRange> ranges() const { return ranges_; }
  [[nodiscard]] Index triangle_count() const { return triangle_count_; }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  Index triangle_count_ = 0;
  std::vector<Triangle> grouped_;  ///< Empty if the mesh is grouped already.
  std::vector<Index> places_;      ///< Per triangle; empty likewise.
  std::vector<DrawRange> ranges_;
};

}  // namespace sunder::scene
