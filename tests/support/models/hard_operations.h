#pragma once

#include <sunder/tear/torn_model.h>

#include <array>
#include <cmath>
#include <vector>

#include "support/machine/random.h"

namespace sunder::test {

/// A sheet, a tube, two tubes that touch, or a soup of triangles.
Character hard_character(Random& random);

/// A pose with bones that are collapsed, mirrored or sheared, or all of them at bind.
ModelPose hard_pose(const Character& character, Random& random);

/// Targets of operations: the posed surface, mainly its vertices.
struct Target {
  std::vector<Vec3d> vertices;
  std::vector<std::array<Vec3d, 3>> faces;
  double size = 0;
};
Target target_of(const Character& character, const ModelPose& pose);

// Operations aimed at a target that has faces: through its vertices, along its edges, in its faces,
// far smaller and far larger than it.
Vec3d place_on(const Target& target, Random& random);
/// Along the axes, along an edge, across a face, or anywhere. Of length 1.
Vec3d direction_at(const Target& target, Random& random);
Stroke hard_stroke(const Target& target, Random& random);
/// Blades that turn by 30 to 170 degrees about a point that is 10 to 1,000 of their lengths away,
/// and step back now and then. The swept surface is much longer than the blades.
Stroke far_turn(const Target& target, Random& random);
TearOptions hard_options(const Target& target, Random& random);
/// In a face or nearly so, through vertices and along edges.
PlaneCut hard_cut(const Target& target, Random& random);
Bore hard_bore(const Target& target, Random& random);

/// As likely in each decade.
inline double any_scale(Random& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}
/// A vector of such a length in any direction.
inline Vec3d any_vector(Random& random, double low, double high) {
  const Vec3d direction = random.direction();
  return any_scale(random, low, high) * direction;
}

}  // namespace sunder::test
