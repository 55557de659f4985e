#pragma once

#include <sunder/particles/soft_body.h>

namespace sunder::particles {

/// A body in the state of another one, to its last bit, without computing it again.
/// @param set  of the same asset as that of the other body; both follow no tear.
/// @throws std::bad_alloc
[[nodiscard]] SUNDER_API SoftBody copy_body(const SoftBody& other, ParticleSet& set);

}  // namespace sunder::particles
