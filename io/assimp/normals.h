#pragma once

#include <span>

#include "io/assimp/mesh_part.h"

namespace sunder::assimp_import {

/// Sets a smooth normal for every vertex in `vertices_without_normal`: the area-weighted mean over
/// the triangles around all vertices with the same position and weights, in all parts, so that
/// seams and material borders have no crease.
void generate_missing_normals(std::span<MeshPart> parts, Notes& notes);

}  // namespace sunder::assimp_import
