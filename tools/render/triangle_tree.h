#pragma once

#include <sunder/core/index.h>
#include <sunder/core/math.h>

#include <array>
#include <span>
#include <vector>

namespace sunder::tools {

/// Triangles in space, for rays. Immutable; any number of threads may ask.
class TriangleTree {
 public:
  using Corners = std::array<Vec3f, 3>;
  struct Hit {
    Index triangle = kNone;  ///< kNone: nothing was met.
    float distance = 0;      ///< In lengths of the ray's direction.
  };

  /// O(n log n).
  explicit TriangleTree(std::span<const Corners> triangles);

  /// The first triangle on a ray, from either side.
  [[nodiscard]] Hit first_hit(const Vec3f& from, const Vec3f& along, float farthest) const;
  /// Whether anything lies between a place and `farthest` lengths of the direction.
  [[nodiscard]] bool is_blocked(const Vec3f& from, const Vec3f& along, float farthest) const;

 private:
  struct Node {
    Vec3f least, greatest;
    Index first = 0;  ///< Of a leaf: its first triangle; otherwise its second child.
    Index count = 0;  ///< Triangles of a leaf; 0: the first child follows the node.
  };
  void build(std::span<const Corners> triangles, std::span<Index> part,
             std::span<const Vec3f> middles);
  template <bool kAny>
  [[nodiscard]] Hit search(const Vec3f& from, const Vec3f& along, float farthest) const;

  std::vector<Node> nodes_;
  std::vector<Corners> triangles_;  ///< In the order of the leaves.
  std::vector<Index> given_;        ///< Per triangle: its index in what was given.
};

}  // namespace sunder::tools
