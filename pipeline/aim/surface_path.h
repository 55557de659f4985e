#pragma once

#include <array>
#include <vector>

#include "pipeline/aim/posed_surface.h"

namespace sunder::aim {

/// A place in a face.
struct FacePlace {
  Index face = 0;
  std::array<double, 3> barycentrics = {};
};

/// A place of a path, and the unit normal of the surface there: of its face, or the mean of the two
/// faces whose edge the path crosses.
struct PathPlace {
  Vec3d position = Vec3d::Zero();
  Vec3d normal = Vec3d::Zero();
};

[[nodiscard]] PathPlace path_place(const PosedSurface& surface, const FacePlace& place);

/// A short path along the surface between two places: the shortest one in a strip of faces. The
/// strip is the one that the shortest path through four points of each edge runs through.
/// @param path  appended: the crossed edges and the end, without the start.
/// @return false if the surface does not connect the places. O(n log n) for n faces that are nearer
///         than the end.
[[nodiscard]] bool append_path(const PosedSurface& surface, const FacePlace& from,
                               const FacePlace& to, std::vector<PathPlace>& path);

}  // namespace sunder::aim
