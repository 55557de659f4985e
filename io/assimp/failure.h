#pragma once

#include <sunder/core/status.h>

namespace sunder::assimp_import {

/// Ends the conversion with a status. Thrown and caught inside the child process only, where assimp
/// throws anyway.
struct ImportFailure {
  Status status;
};

}  // namespace sunder::assimp_import
