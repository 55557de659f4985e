#pragma once

#include "tools/validate/validate.h"
#include "tools/validation_page/page_input.h"

namespace sunder::tools {

/// The content of the page of a comparison; it refers to `pair`.
[[nodiscard]] PageInput page_input(const ValidatedPair& pair);

}  // namespace sunder::tools
