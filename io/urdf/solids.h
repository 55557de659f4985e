#pragma once

#include <sunder/core/mesh.h>

#include "io/urdf/tags.h"

namespace sunder::urdf {

// Meshes of URDF's own shapes, around the origin, with normals: one submesh without material.

[[nodiscard]] Mesh box_mesh(const BoxTag& box);
/// Along z, closed, of 32 sides.
[[nodiscard]] Mesh cylinder_mesh(const CylinderTag& cylinder);
/// A sphere of 24 by 12 faces, with the poles at z.
[[nodiscard]] Mesh sphere_mesh(const SphereTag& sphere);

}  // namespace sunder::urdf
