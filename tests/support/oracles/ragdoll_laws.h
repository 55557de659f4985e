#pragma once

#include <sunder/ragdoll/ragdoll.h>

#include "support/machine/random.h"

namespace sunder::test {

/// What holds for every ragdoll: its bodies are rigid and heavy and hold their parts of the
/// surface; its joints hang together and are within their limits as they start; poses and places of
/// bodies follow from one another.
void expect_ragdoll_laws(const Character& character, const ModelPose& pose, const Ragdoll& ragdoll,
                         Random& random);

}  // namespace sunder::test
