#pragma once

#include <sunder/core/mesh.h>

#include <span>
#include <vector>

namespace sunder::bodies {

/// Whether the library was built with Qhull.
[[nodiscard]] bool has_qhull();

/// The faces of the hull of points that are not in one plane, of any winding; none on failure:
/// without Qhull, without enough memory, or where Qhull gives up.
/// @param points  finite, about one unit in size. @throws std::bad_alloc
[[nodiscard]] std::vector<Triangle> hull_faces(std::span<const Vec3d> points);

}  // namespace sunder::bodies
