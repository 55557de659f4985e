#pragma once

#include <sunder/core/character.h>

namespace sunder::bench {

/// The Stanford bunny of ../shared/models (3,485 points) or, where it is absent, a ball with bumps
/// of about as many points; each face in `divisions` x `divisions` parts; with normals and one UV
/// set, on `bone_count` bones in a chain along its longest axis, up to four smooth influences per
/// vertex. The surface is that of the base model at any number of divisions.
[[nodiscard]] Character make_subdivided_model(int divisions, std::uint32_t bone_count);

}  // namespace sunder::bench
