#pragma once

#include <sunder/core/index.h>
#include <sunder/core/math.h>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace sunder::tools {

/// Triangles in space, for rays, which Embree finds. Immutable; any number of threads may ask. The
/// same bits on every x86-64 CPU, because Embree uses the same instructions on all of them.
class TriangleTree {
 public:
  using Corners = std::array<Vec3f, 3>;
  struct Hit {
    Index triangle = kNone;  ///< kNone: nothing was met.
    float distance = 0;      ///< In lengths of the ray's direction.
  };
  enum class Ray : std::uint8_t { sight, shadow };
  /// Some triangles have holes, through which rays pass.
  struct Holes {
    std::vector<bool> may_be_in;  ///< Per triangle.
    /// Whether a ray passes a triangle at a place, given by the shares of its corners. Called by
    /// several threads.
    std::function<bool(Index triangle, const Vec3f& shares, Ray ray)> lets_pass;
  };

  /// O(n log n). Triangles with corners that are not finite are never met. Throws std::bad_alloc.
  explicit TriangleTree(std::span<const Corners> triangles);
  TriangleTree(std::span<const Corners> triangles, Holes holes);
  ~TriangleTree();
  TriangleTree(const TriangleTree&) = delete;
  TriangleTree& operator=(const TriangleTree&) = delete;

  /// The first triangle on a ray, from either side, between two distances. None for a ray that is
  /// not finite, or has a number beyond 1.8e18.
  [[nodiscard]] Hit first_hit(const Vec3f& from, const Vec3f& along, float farthest = kFar,
                              float nearest = 0) const;
  /// Whether anything lies between a place and `farthest` lengths of the direction.
  [[nodiscard]] bool is_blocked(const Vec3f& from, const Vec3f& along, float farthest = kFar) const;

  static constexpr std::size_t kBundle = 4;  ///< Rays that Embree follows at once.
  /// The same for rays from one place, without a farthest distance; faster than one by one.
  [[nodiscard]] std::array<Hit, kBundle> first_hits(const Vec3f& from,
                                                    const std::array<Vec3f, kBundle>& along) const;
  /// Per ray: whether it is blocked. At most kBundle rays.
  [[nodiscard]] std::array<bool, kBundle> are_blocked(const Vec3f& from,
                                                      std::span<const Vec3f> along) const;

  static constexpr float kFar = std::numeric_limits<float>::max() / 4;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sunder::tools
