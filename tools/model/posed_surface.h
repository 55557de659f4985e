#pragma once

#include <sunder/skinning/pose.h>

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "tools/model/posed_model.h"

namespace sunder::tools {

/// The corners of a triangle. Those of a segment or a point repeat a corner.
using Corners = std::array<Vec3d, 3>;

/// The triangles of all meshes of a character in a pose, model space; without retired ones.
struct PosedSurface {
  static constexpr std::size_t kRun = 64;  ///< Triangles per entry of `run_bounds`.

  std::vector<Corners> triangles;
  std::vector<Bounds> run_bounds;  ///< Of successive triangles, which are mostly neighbours.
  Bounds bounds;
};
/// @return the failures of deform_model(). O(vertices + triangles).
[[nodiscard]] Result<PosedSurface> pose_surface(const Character& character, const ModelPose& pose);

/// The distance between two triangles; 0 if they meet.
[[nodiscard]] double distance_between(const Corners& a, const Corners& b);

/// Where two things are nearest to each other.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();  ///< Infinite: there is nothing.
  std::size_t part = 0, triangle = 0;                         ///< Of the shape and of the surface.
};
/// Where a surface and some triangles are nearest. The search ends at a distance of at most
/// `enough`. At most O(product of the numbers of triangles).
[[nodiscard]] Nearest find_nearest(const PosedSurface& surface, std::span<const Corners> shape,
                                   double enough = 0.0);
[[nodiscard]] inline double distance_between(const PosedSurface& surface,
                                             std::span<const Corners> shape, double enough = 0.0) {
  return find_nearest(surface, shape, enough).distance;
}

/// The places of two triangles that do not meet which are nearest to each other.
struct NearestPlaces {
  Vec3d of_first = Vec3d::Zero(), of_second = Vec3d::Zero();
};
[[nodiscard]] NearestPlaces nearest_places(const Corners& first, const Corners& second);

/// Where a ray first meets a surface beyond `after`: the multiple of `direction`.
[[nodiscard]] std::optional<double> first_hit(const PosedSurface& surface, const Vec3d& origin,
                                              const Vec3d& direction, double after = 0.0);

/// Whether a surface winds around a point. Surfaces with openings count as closed where they
/// surround the point more than halfway (generalised winding number).
[[nodiscard]] bool is_inside(const PosedSurface& surface, const Vec3d& point);

}  // namespace sunder::tools
