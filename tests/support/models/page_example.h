#pragma once

#include <sunder/core/character.h>
#include <sunder/validation/finding.h>

#include <vector>

#include "tools/validation_page/page_input.h"

namespace sunder::test {

/// The cactus of the demo, compared with itself cut to its two largest influences per vertex.
struct PageExample {
  Character source, target;
  std::vector<Finding> findings;
  /// Refers to the members above: valid as long as this object stays where it is.
  tools::PageInput input;
};

/// Everything that the page can show, measured over the clip and over seeded random poses.
void make_page_example(PageExample& example);

/// Each bone of the target moved by the bone of that name.
std::vector<Index> bones_by_name(const Skeleton& source, const Skeleton& target);

/// All vertices of a character in a pose, mesh by mesh.
std::vector<Vec3d> all_posed_positions(const Character& character, const ModelPose& pose);

}  // namespace sunder::test
