#pragma once

#include <sunder/operation/operation.h>

namespace sunder::bench {

// Operations on the tube of make_engine_model().

/// Options of a tear with walls, 3 cm deep.
[[nodiscard]] TearOptions walled(double width);
/// The blade of a stroke across the front, at a share of its way.
[[nodiscard]] Blade engine_stroke_at(double way);
/// A wavy stroke of 16 cm across the front, above that one. @param height  of its middle, metres.
[[nodiscard]] Stroke engine_gap(int segments, double length = 0.16, double height = 1.3);
/// A cut with caps below the upper end, and a place on what it severs.
[[nodiscard]] PlaneCut engine_cut();
inline const PieceNear kEnginePiece = {{0, 2, 0}, {}};
/// A bore with a wall into the lower front.
[[nodiscard]] Bore engine_bore();

}  // namespace sunder::bench
