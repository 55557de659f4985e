#pragma once

#include <span>

#include "tools/picture/open_lips.h"

namespace sunder::tools {

/// Chooses the tension and its share in each wound, by how far the tissue opens under others, and
/// closes the lips again: each wound gapes by a share of its own length, or less where the body is
/// thin below it, or where the surface beside it would fold.
/// @param thicknesses  of the body below each wound, metres; infinite where none was found.
[[nodiscard]] Status choose_tensions(GapingModel& model, const ModelPose& pose,
                                     std::span<const double> thicknesses);

}  // namespace sunder::tools
