#pragma once

#include <sunder/core/character.h>

#include <vector>

#include "tools/model/posed_model.h"

namespace sunder::tools {

/// A posed model as a still scene.
///
/// @param colors  per mesh, one linear RGBA per vertex; meshes beyond the end have no colours.
[[nodiscard]] Character make_still(const Character& character,
                                   const std::vector<DeformedMesh>& posed,
                                   const std::vector<std::vector<Vec4f>>& colors = {});

/// Gives a colour, linear RGBA, to all parts of a still scene that have none.
void paint(Character& still, const Vec4f& color);

}  // namespace sunder::tools
