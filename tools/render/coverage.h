#pragma once

#include <vector>

#include "tools/render/render_scene.h"
#include "tools/render/render_view.h"

namespace sunder::tools {

/// The parts of a picture in which surfaces may be seen, in cells of a few pixels.
class Coverage {
 public:
  Coverage(const RenderScene& scene, const RenderView& view);

  /// Whether a ray through a pixel may meet a surface.
  [[nodiscard]] bool may_show(int x, int y) const {
    return is_covered_[static_cast<std::size_t>(y / kCell) * columns_ +
                       static_cast<std::size_t>(x / kCell)];
  }

 private:
  static constexpr int kCell = 8;
  std::size_t columns_ = 0;
  std::vector<bool> is_covered_;
};

}  // namespace sunder::tools
