#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "tools/picture/open_lips.h"

namespace sunder::tools {

/// The places of a character's points in one pose.
[[nodiscard]] std::vector<Vec3f> places_of_points(const CharacterInstance& instance,
                                                  const std::vector<DeformedMesh>& posed);

/// The points of a character's surface in one pose, which are joined by edges, and which lie on
/// lips.
class SurfacePoints {
 public:
  SurfacePoints(const CharacterInstance& instance, const std::vector<DeformedMesh>& posed);

  [[nodiscard]] const Vec3f& place(std::uint32_t point) const { return places_[point]; }
  [[nodiscard]] const std::vector<Vec3f>& places() const { return places_; }
  [[nodiscard]] bool is_lip(std::uint32_t point) const { return is_lip_[point]; }
  [[nodiscard]] double distance(std::uint32_t a, std::uint32_t b) const {
    return static_cast<double>((places_[a] - places_[b]).norm());
  }
  /// Points of triangles, without those that are no particles'.
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }

  template <class Visit>
  void for_each_neighbour(std::uint32_t point, Visit&& visit) const {
    const auto first =
        std::lower_bound(edges_.begin(), edges_.end(), std::array<std::uint32_t, 2>{point, 0});
    for (auto edge = first; edge != edges_.end() && (*edge)[0] == point; ++edge) visit((*edge)[1]);
  }

  /// Calls visit(neighbour, weight) for each neighbour of a point; edges weigh more the shorter
  /// they are.
  template <class Visit>
  void for_each_weighted(std::uint32_t point, Visit&& visit) const {
    for_each_neighbour(point, [&](std::uint32_t other) {
      const auto length = static_cast<float>(distance(point, other));
      visit(other, 1 / std::max(length, std::numeric_limits<float>::min()));
    });
  }

 private:
  std::vector<Vec3f> places_;
  std::vector<bool> is_lip_;  ///< Per point.
  std::vector<Triangle> triangles_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
};

}  // namespace sunder::tools
