#pragma once

#include "tools/picture/view.h"
#include "tools/render/render_scene.h"

namespace sunder::tools {

struct WoundView {
  ViewFrame frame;
  /// Whether other surfaces cover the wound from all sides: a slash below a robe, or in a gap.
  bool is_covered = false;
};

/// The view from which a wound is seen: the preferred one if more than half as much flesh is
/// visible there as from anywhere, else one nearby that shows much. Tries 80 views around the scene
/// and finds by rays what hides the flesh, a robot too. O(flesh triangles), 2,000 at most.
[[nodiscard]] WoundView see_wound(const RenderScene& scene, const ViewFrame& preferred);

}  // namespace sunder::tools
