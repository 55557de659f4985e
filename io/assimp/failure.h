#pragma once

#include <sunder/core/status.h>

namespace sunder::assimp_import {

/// Ends the conversion with a status. Thrown and caught only during an import, where assimp throws
/// too.
struct ImportFailure {
  Status status;
};

}  // namespace sunder::assimp_import
