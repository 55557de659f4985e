#pragma once

#include <sunder/validation/validation.h>

namespace sunder::validation {

/// The codes of the table in codes.cpp, in its order.
enum class Code : std::uint8_t {
  sum,
  sum_integer,
  rounding,
  negative,
  not_finite,
  duplicate,
  out_of_range,
  unweighted,
  unsorted,
  many_influences,
  prunable,
  zero_joint,
  repaired,
  dropped,
  copied,
  swapped,
  first_kept,
  bones_swapped,
  moved_to_first,
  bone_missing,
  bone_fuzzy,
  bone_unused,
  unmatched,
  deviation,
  stretch,
  normal,
  inversion,
  pop,
  crack,
  lip_welded,
  t_junction,
  rough,
  island,
  bleed,
  across_tear,
  wrong_side,
  symmetry,
  mesh_health,
  morph_lost,
  normals,
  tangents,
  uv,
  bind,
  default_pose,
  clips,
  scale,
  profile,
  cert_deviation,
  cert_crack,
  cert_collapse,
};

[[nodiscard]] const FindingKind& kind_of(Code code);

}  // namespace sunder::validation
