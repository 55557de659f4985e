#pragma once

#include "io/gltf_read/reading.h"

namespace sunder::gltf {

/// Notes images in other files that do not exist, or must not be read. They are no part of a
/// character, so a missing one is information; the references stay in the document.
void note_images(Reading& reading);

}  // namespace sunder::gltf
