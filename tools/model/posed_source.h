#pragma once

#include <sunder/core/character.h>

#include <list>
#include <memory>

#include "tools/model/posed_surface.h"

namespace sunder::tools {

/// The surface of an untorn source in the poses of some operations. The last ones are kept, because
/// operations often share their poses: 16, or fewer of a model with more than 60,000 triangles.
class PosedSource {
 public:
  explicit PosedSource(std::shared_ptr<const Character> source) : source_(std::move(source)) {}

  /// Valid until the next call. O(vertices), or O(bones) for a pose that is kept.
  [[nodiscard]] Result<const PosedSurface*> in(const ModelPose& pose);

 private:
  struct Kept {
    ModelPose pose;
    PosedSurface surface;
  };
  std::shared_ptr<const Character> source_;
  std::list<Kept> kept_;  ///< Latest first.
};

}  // namespace sunder::tools
