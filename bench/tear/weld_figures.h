#pragma once

namespace sunder::bench {

/// Tears of about a hundred faces on a tube, each welded again.
struct WeldFigures {
  double weld_ms = 0, vs_tear = 0;  ///< Medians.
  /// The largest distance of a welded point from the untorn surface over random poses, in diagonals
  /// of the model: with weights of the policies `exact` and `barycentric`.
  double position_error = 0, position_error_barycentric = 0;
  double open_share = 0;  ///< Of the welds, after which borders or components are others.
};
[[nodiscard]] WeldFigures measure_welds();

}  // namespace sunder::bench
