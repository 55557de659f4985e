#pragma once

#include <span>

#include "io/assimp/mesh_part.h"

namespace sunder::assimp_import {

/// Gives every vertex in `vertices_without_normal` a smooth one: the area-weighted mean over the
/// triangles around all vertices of the same position and weights, across the parts, so that
/// neither seams nor materials crease.
void generate_missing_normals(std::span<MeshPart> parts, Notes& notes);

}  // namespace sunder::assimp_import
