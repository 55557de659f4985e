#pragma once

#include <string>

#include "tools/messages/json.h"
#include "tools/written_weights/certified_weights.h"

namespace sunder::tools {

/// The choice of `--max-error`: certified maximum, influences, formats, bytes; see
/// docs/command/tear.md.
[[nodiscard]] Json certificate_json(const CertifiedWeights& weights, const Character& unpruned,
                                    const MaximumError& wanted);

/// The same for people, one line.
[[nodiscard]] std::string certificate_line(const CertifiedWeights& weights,
                                           const MaximumError& wanted);

}  // namespace sunder::tools
