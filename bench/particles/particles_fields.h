#pragma once

#include <string>
#include <vector>

namespace sunder::bench {

/// A slit of 0.4 m in a sheet of one metre whose tissue varies from place to place, under a tension
/// of 1.2 N/m, against finite elements with the same fields.
struct FieldFigures {
  std::string name;
  double range = 0;  ///< Metres.
  double width = 0;  ///< Of the widest gap by that of the reference, less 1; mean over the orders.
  double rms = 0;    ///< Of the gap along the slit, by the widest; root mean square of the orders.
  /// The load at which a tip runs on by that of the reference, less 1. Only where the field is the
  /// same at both tips.
  double load = 0;
  bool has_load = false;
};

/// Fields of stiffness, thickness and tension, for ranges of 0.2, 0.1 and 0.05 m, over six orders
/// of seeds.
[[nodiscard]] std::vector<FieldFigures> measure_fields();

/// A slit that runs on along a curved perforation.
struct PerforationFigures {
  double follow = 0;  ///< The greatest distance of a point of the lips from the line, metres.
  double length = 0;  ///< Of the tear by that of the line.
};
[[nodiscard]] PerforationFigures measure_perforation();

/// The duration of a step in which lips are pressed together, with self-contact by that without.
[[nodiscard]] double measure_self_contact_ratio();

}  // namespace sunder::bench
