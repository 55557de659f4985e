#pragma once

#include <sunder/core/api.h>

namespace sunder {

/// Lets refits of this program fit neighbouring points together (RefitOptions::is_coupled), with
/// Ceres. Call it once, before the first such refit, on any thread. This library alone needs Ceres,
/// whose Debian package links parts of SuiteSparse that are under the GPL.
SUNDER_API void use_coupled_refit();

}  // namespace sunder
