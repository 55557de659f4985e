#pragma once

#include <sunder/core/character.h>
#include <sunder/io/character_bytes.h>

#include "io/gltf/glb.h"

namespace sunder::gltf {

/// Appends SaveOptions::materials and SaveOptions::painted to those of a draft, if a submesh of the
/// character names one.
void append_materials(const Character& character, const SaveOptions& options, GlbDraft& draft);

/// @param index  of the material in SaveOptions::painted. @throws Refusal
void check_painted(const PaintedMaterial& painted, Index index);

}  // namespace sunder::gltf
