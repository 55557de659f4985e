#pragma once

#include <cstddef>

#include "io/internal/descriptor.h"

namespace sunder::files {

/// Reads up to `bytes` bytes at `offset`.
/// @return the number read, less at the end of the file or after an error.
std::size_t read_at(const Descriptor& descriptor, void* target, std::size_t bytes,
                    std::size_t offset);

}  // namespace sunder::files
