#pragma once

#include <sunder/core/character.h>

namespace sunder::test {

/// The tube of make_tube() on three bones, with its side and caps in charts of their own, inside
/// the texture.
Character make_atlas_tube(std::uint32_t rings, std::uint32_t sides);

/// The largest side of a texel on the surface of a mesh, whose texture has `size` texels a side.
double texel_size(const Mesh& mesh, std::uint32_t size);

}  // namespace sunder::test
