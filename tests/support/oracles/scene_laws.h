#pragma once

#include <sunder/scene/scene.h>

#include <string>
#include <vector>

#include "support/machine/random.h"

namespace sunder::test {

/// Checks what must hold in a scene after an update, whatever snapshot it was restored from: the
/// vertices that it drew are finite, and the particles of these instances keep their laws. One
/// sentence per fault.
/// @param checks_cells  as of broken_particles(). Restoring compares the cells of now with the
///                      surface; of those to which undo leads only the range.
std::vector<std::string> broken_scene(Scene& scene, bool checks_cells = true);

/// Goes on with a scene as an engine does: updates, and undoes, redoes, tears, cuts and takes a
/// piece off all instances that are drawn. Commands may fail. @return the first faults of
/// broken_scene(); empty if there are none.
std::vector<std::string> play_on(Scene& scene, Random& random);

}  // namespace sunder::test
