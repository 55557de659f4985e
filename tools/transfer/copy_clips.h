#pragma once

#include <sunder/validation/transfer.h>

namespace sunder::tools {

/// Appends the clips of a source to the target that got its skin. Channels of bones that the target
/// lacks, and of morph weights, are left out; clips without any other channel too.
/// @return the number of clips that were appended; invalid_argument if a bone that they move stands
///         otherwise in the target's rest pose, because keys are relative to the parent bone.
[[nodiscard]] Result<std::size_t> copy_clips(const Character& source, TransferResult& result);

}  // namespace sunder::tools
