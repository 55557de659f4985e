#pragma once

#include <string>
#include <vector>

#include "tools/model/history.h"
#include "tools/model/posed_model.h"
#include "tools/picture/marks.h"

namespace sunder::tools {

/// The extreme places of the blades, planes and bores, for the camera; those far outside of the
/// model are left out.
[[nodiscard]] std::vector<Vec3d> places_of(const std::vector<NumberedOperation>& operations,
                                           const Bounds& model);

/// A text for a place of the picture.
struct OperationLabel {
  Vec3d place;
  std::string text;
};

/// Draws what operations will do: strokes red with green squares at the bases and yellow discs at
/// the tips of their blades, planes blue, bores violet. Swept faces are translucent and lie in the
/// scene; their lines are on top, so they can be seen through the model.
/// @return the index of each operation, to be written where it begins.
[[nodiscard]] std::vector<OperationLabel> draw_operations(
    const std::vector<NumberedOperation>& operations, const Bounds& model, Marks& marks);

/// Lists the operations that are not in the picture, or only partly, one line each.
[[nodiscard]] std::vector<std::string> missing_from_picture(
    const std::vector<NumberedOperation>& operations, const Bounds& model,
    const Viewport& viewport);

}  // namespace sunder::tools
