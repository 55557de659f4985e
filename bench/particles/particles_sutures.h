#pragma once

#include <vector>

namespace sunder::bench {

/// A slit of 0.6 m in a sheet of one metre, sewn and pulled at by 1.2 N/m, against finite elements
/// whose threads grip half a range of the lips to either side.
struct SutureFigures {
  double range = 0, spacing = 0;  ///< Metres.
  double stiffness = 0;           ///< Of a thread, N/m.
  double sewn = 0;                ///< The widest gap between threads by that of the open slit.
  double error = 0;  ///< Of it by that of the reference, less 1; mean over three orders of seeds.
};

/// Spacings of 1.5 ranges and more.
[[nodiscard]] std::vector<SutureFigures> measure_sutures();

}  // namespace sunder::bench
