#pragma once

#include <string>
#include <vector>

#include "tools/tear/tear_play.h"

namespace sunder::tools {

/// What a wanted operation is for the model as it is now.
struct PlainTears {
  Operation operation;
  std::vector<Operation> detachments;  ///< To apply after it.
  std::vector<std::string> notes;      ///< To be said: what was chosen.
};

/// Turns an operation that names bones into plain ones. One of the command line counts at the
/// nearest share that works if it gives none, is seen as the character faces, and takes off what it
/// severs if that is wanted.
/// @return the failures of resolve().
[[nodiscard]] Result<PlainTears> plain_tears(const WantedOperation& wanted, const TearRun& run);

/// Names like one that an operation names in vain.
[[nodiscard]] std::string advice_on(const WantedOperation& wanted, const Character& source);

}  // namespace sunder::tools
