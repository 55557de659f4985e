#pragma once

#include <sunder/core/mesh.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace sunder::bench {

/// Ray queries by Embree 3 on posed vertices: a tree over all triangles that is refitted whenever
/// the vertices change.
class EmbreePeer {
 public:
  explicit EmbreePeer(const Mesh& mesh);
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  /// The posed vertices, to be written before refit().
  [[nodiscard]] std::span<Vec3f> positions();
  /// Adapts the tree to the positions.
  void refit();
  /// @return the distance of the first hit. @param direction  of unit length.
  [[nodiscard]] std::optional<float> cast_ray(const Vec3f& origin, const Vec3f& direction) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sunder::bench
