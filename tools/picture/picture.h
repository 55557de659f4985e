#pragma once

#include <sunder/tear/torn_model.h>

#include <filesystem>
#include <vector>

#include "tools/model/posed_model.h"
#include "tools/picture/render.h"
#include "tools/picture/rims.h"
#include "tools/picture/view.h"

namespace sunder::tools {

/// A posed model as a still scene.
///
/// @param colors  per mesh, one linear RGBA per vertex; meshes beyond the end have no colours.
[[nodiscard]] Character make_still(const Character& character,
                                   const std::vector<DeformedMesh>& posed,
                                   const std::vector<std::vector<Vec4f>>& colors = {});

/// A torn model as a still scene. The inside that is visible through openings is red, and rims get
/// a red edge as thick as the flesh. The walls and caps of the model are red too.
///
/// @param posed      with the lips pulled open.
/// @param closed     in the same pose, with closed lips.
/// @param untorn     the source in the same pose.
/// @param frame      the view.
/// @param thickness  of the flesh, metres; reduced where the model is thin.
[[nodiscard]] Character make_torn_still(const TornModel& torn,
                                        const std::vector<DeformedMesh>& posed,
                                        const std::vector<DeformedMesh>& closed,
                                        const std::vector<DeformedMesh>& untorn,
                                        const std::vector<RimEdge>& rims, const ViewFrame& frame,
                                        double thickness);

/// Gives a colour, linear RGBA, to all parts of a still scene that have none.
void paint(Character& still, const Vec4f& color);

/// Draws a still scene into a PNG with f3d under Xvfb. Takes about a second.
[[nodiscard]] Status draw(const Character& still, const Camera& camera, int width, int height,
                          const std::filesystem::path& png);

}  // namespace sunder::tools
