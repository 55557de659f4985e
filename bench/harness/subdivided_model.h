#pragma once

#include <sunder/core/character.h>

namespace sunder::bench {

/// The Stanford bunny of ../shared/models (3,485 points) or, if it is absent, a ball with bumps and
/// about as many points. Each face is divided into `divisions` x `divisions` faces on the same
/// surface. With normals and one UV set, on `bone_count` bones in a chain along its longest axis,
/// up to four smooth influences per vertex.
[[nodiscard]] Character make_subdivided_model(int divisions, std::uint32_t bone_count);

}  // namespace sunder::bench
