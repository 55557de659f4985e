#pragma once

#include <sunder/core/character.h>

#include <string>
#include <vector>

#include "io/usd_write/identifiers.h"
#include "io/usd_write/usd_text.h"

namespace sunder::usd {

/// The names by which animations drive morph weights: one per entry of Pose::morph_weights, empty
/// where no written mesh has it. Meshes that share a weight share its name.
[[nodiscard]] std::vector<std::string> blend_shape_names(const Character& character);

/// The properties of a mesh that name its blend shapes, which are prims below it.
/// @param path  of the mesh.
void write_blend_shape_bindings(UsdText& text, const Mesh& mesh, const std::string& path,
                                const std::vector<std::string>& names);

/// The blend shapes of a mesh, with the points that each moves.
/// @param children  the names of the mesh's prims.
void write_blend_shapes(UsdText& text, const Mesh& mesh, const std::vector<std::string>& names,
                        Identifiers& children);

}  // namespace sunder::usd
