#pragma once

#include <sunder/operation/operation.h>

#include "tear/posed/workpiece.h"
#include "tear/weld/lip_partners.h"

namespace sunder::tear {

/// Which lips a weld closes, of those that have others on them: per lip.
[[nodiscard]] ScratchVector<bool> choose_lips(const Weld& weld, std::span<const Lip> lips,
                                              std::span<const LipOverlap> overlaps,
                                              const Workpiece& work);

}  // namespace sunder::tear
