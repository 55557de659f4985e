#pragma once

#include <vector>

#include "support/refit_gains.h"

namespace sunder::bench {

/// The gains of refits on rigs that they were not tuned on, each with three seeds of four tears:
/// every file of ../shared/models/rigged and of Debian's assimp-testmodels that loads, is skinned
/// and has a clip; and 200 random rigs. Files that are absent are left out.
[[nodiscard]] std::vector<test::RefitGains> measure_refit_rigs();

}  // namespace sunder::bench
