#pragma once

#include <sunder/core/mesh.h>

namespace sunder::urdf {

/// Appends a mesh, moved by a transform, to another one: positions, normals, texture coordinates,
/// colours, triangles, submeshes. Normals that are missing are computed from the faces. Mirroring
/// transforms keep faces counter-clockwise.
/// @param transform  invertible.
void append_mesh(Mesh& into, const Mesh& mesh, const Affine3d& transform);

}  // namespace sunder::urdf
