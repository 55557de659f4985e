#pragma once

#include <sunder/core/character.h>

#include <filesystem>
#include <vector>

#include "tools/posed_model.h"
#include "tools/pull_open.h"
#include "tools/view.h"

namespace sunder::tools {

struct Camera {
  Vec3d eye, focal_point, up;
  double view_angle_degrees = 30;
};

/// A posed model as a still scene.
[[nodiscard]] Character make_still(const Character& character, const std::vector<DeformedMesh>& posed);

/// A torn model as a still scene, pulled open: walls seen from within through the gap are red, a little before the surface itself,
/// and the lips have a red rim.
///
/// @param closed     the same pose before it was pulled open.
/// @param frame      from where it will be seen.
/// @param thickness  of the flesh, metres; less where the model is thin.
[[nodiscard]] Character make_torn_still(const Character& character, const std::vector<DeformedMesh>& posed,
                                        const std::vector<DeformedMesh>& closed, const std::vector<PullOpen::Lip>& lips,
                                        const ViewFrame& frame, double thickness);

/// Whether the programs that draw are installed: f3d and xvfb-run.
[[nodiscard]] bool can_draw();

/// Draws a still scene into a PNG by f3d under Xvfb; about a second.
[[nodiscard]] Status draw(const Character& still, const Camera& camera, const std::filesystem::path& png);

}  // namespace sunder::tools
