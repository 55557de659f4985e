#pragma once

#include <vector>

#include "io/internal/still_scene.h"
#include "tools/picture/view.h"

namespace sunder::tools {

/// Lights from the upper left, and weaker from the right and from below, so that no side is black.
[[nodiscard]] std::vector<StillScene::Light> lights_of(const ViewFrame& frame);

}  // namespace sunder::tools
