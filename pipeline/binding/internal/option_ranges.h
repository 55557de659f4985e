#pragma once

#include "core/internal/number_range.h"

namespace sunder::binding {

/// The range of HeatOptions::heat, by which the command checks too.
inline constexpr NumberRange kHeat = {.field = "heat", .least = 1e-9, .most = 1e9};

}  // namespace sunder::binding
