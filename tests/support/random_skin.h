#pragma once

#include <sunder/core/mesh.h>

#include "support/random.h"

namespace sunder::test {

struct RandomSkin {
  std::uint32_t vertices = 100;
  std::uint32_t slots = 8;
  std::uint32_t influences = 4;  ///< At most.
  std::uint32_t morph_targets = 0;
  bool tangents = false;
  /// Slots of neighbouring vertices lie within as many of one another; `slots`: anywhere.
  std::uint32_t spread = 8;
};

/// Vertices without triangles, at random places within a metre of the origin, normals and weights
/// at random, all bits odd.
[[nodiscard]] Mesh make_random_skin(Random& random, const RandomSkin& wanted);

/// Bones turned at random, up to half a metre away; with `scale` > 1 also scaled by up to as much,
/// unevenly, and sheared, some mirrored.
[[nodiscard]] std::vector<Affine3d> random_palette(Random& random, std::uint32_t slots,
                                                   double scale = 1.0);

/// In float, and what floats hold of it in double.
[[nodiscard]] std::vector<Affine3f> in_float(const std::vector<Affine3d>& palette);
[[nodiscard]] std::vector<Affine3d> in_double(const std::vector<Affine3f>& palette);

}  // namespace sunder::test
