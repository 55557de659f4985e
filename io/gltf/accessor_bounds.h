#pragma once

#include <cstdint>
#include <span>

#include "io/gltf/source_document.h"

namespace sunder::gltf {

/// Replaces `min` and `max` of the accessors that have these and read from one of the views.
/// Filters of compressed data round, so a file may declare the bounds of what was rounded. The
/// views must have been checked.
void correct_bounds(SourceDocument& document, std::span<const std::uint32_t> views);

}  // namespace sunder::gltf
