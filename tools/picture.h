#pragma once

#include <sunder/tear/torn_model.h>

#include <filesystem>
#include <vector>

#include "tools/posed_model.h"
#include "tools/rims.h"
#include "tools/view.h"

namespace sunder::tools {

struct Camera {
  Vec3d eye, focal_point, up;
  double view_angle_degrees = 30;
};

/// A posed model as a still scene.
///
/// @param colors  a mesh each, a vertex each, linear RGBA; fewer: the others have none.
[[nodiscard]] Character make_still(const Character& character,
                                   const std::vector<DeformedMesh>& posed,
                                   const std::vector<std::vector<Vec4f>>& colors = {});

/// A torn model as a still scene: walls seen from within through what is open are red, a little
/// before the surface itself, and the rims have a red edge as thick as the flesh. So are walls and
/// caps that the model has.
///
/// @param posed      pulled open.
/// @param closed     the same pose before it was pulled open.
/// @param untorn     the source in that pose.
/// @param frame      from where it will be seen.
/// @param thickness  of the flesh, metres; less where the model is thin.
[[nodiscard]] Character make_torn_still(const TornModel& torn,
                                        const std::vector<DeformedMesh>& posed,
                                        const std::vector<DeformedMesh>& closed,
                                        const std::vector<DeformedMesh>& untorn,
                                        const std::vector<RimEdge>& rims, const ViewFrame& frame,
                                        double thickness);

/// Gives all of a still scene that has no colour of its own this one; linear RGBA.
void paint(Character& still, const Vec4f& color);

/// Whether the programs that draw are installed: f3d and xvfb-run.
[[nodiscard]] bool can_draw();

/// Draws a still scene into a PNG by f3d under Xvfb; about a second.
[[nodiscard]] Status draw(const Character& still, const Camera& camera, int width, int height,
                          const std::filesystem::path& png);

}  // namespace sunder::tools
