#pragma once

#include <memory>
#include <string>
#include <vector>

#include "support/oracles/refit_gains.h"

namespace sunder::bench {

struct BendingRig {
  std::string name;
  std::shared_ptr<const Character> character;
};

/// Rigs that refits were not tuned on: every file of ../shared/models/rigged and of Debian's
/// assimp-testmodels that loads, is skinned and has a clip; and random rigs. Files that are absent
/// are left out.
[[nodiscard]] std::vector<BendingRig> bending_rigs(int random_rigs);

/// The gains of refits on these and 200 random rigs, each with three seeds of four tears.
[[nodiscard]] std::vector<test::RefitGains> measure_refit_rigs();

}  // namespace sunder::bench
