#pragma once

#include "tear/contact/searches.h"

namespace sunder::tear {

/// @return index_out_of_range, non_finite_value or invalid_argument.
[[nodiscard]] Status check_anchor(const SurfaceAnchor& anchor, const SurfaceEditor& editor);

/// The part of its triangle in which a place lies now; empty if that part was removed.
[[nodiscard]] std::optional<FoundPlace> find_part(const SurfaceAnchor& anchor,
                                                  const SurfaceEditor& editor);

}  // namespace sunder::tear
