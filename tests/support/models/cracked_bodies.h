#pragma once

#include <sunder/core/character.h>

#include <string>
#include <vector>

#include "support/machine/random.h"

namespace sunder::test {

/// A ball or a tube of one mesh, closed in bind space.
Character closed_body(Random& random);

/// The same with one to three cracks: edges whose two sides coincide in bind space and have other
/// weights.
Character cracked_body(Random& random);
/// Cracks whose sides hardly come apart, as files make them that store weights in few bits.
Character coarsely_weighted_body(Random& random);

/// Edges of the bind surface, welded by position alone, whose faces do not match.
std::vector<std::string> unmatched_edges(const Character& character);

}  // namespace sunder::test
