#pragma once

#include <sunder/ragdoll/ragdoll.h>

#include "support/machine/random.h"

namespace sunder::test {

/// By how many radians a turn of a joint leaves its limit: the twist its range, or the swing its
/// cone, which of a hinge is 0.
double beyond_limit(const Quatd& turn, const BoneLimit& limit);

/// What holds for every ragdoll: its bodies are rigid and heavy and hold their parts of the
/// surface; its joints hang together and are within their limits as they start; poses and places of
/// bodies follow from one another.
void expect_ragdoll_laws(const Character& character, const ModelPose& pose, const Ragdoll& ragdoll,
                         Random& random);

}  // namespace sunder::test
