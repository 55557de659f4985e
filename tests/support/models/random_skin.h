#pragma once

#include <sunder/core/mesh.h>

#include "support/machine/random.h"

namespace sunder::test {

struct RandomSkin {
  std::uint32_t vertices = 100;
  std::uint32_t slots = 8;
  std::uint32_t influences = 4;  ///< At most.
  std::uint32_t morph_targets = 0;
  bool tangents = false;
  /// Maximum difference between the slots of neighbouring vertices; `slots`: any.
  std::uint32_t spread = 8;
};

/// Vertices without triangles, at random positions within a metre of the origin, with random
/// normals and weights.
[[nodiscard]] Mesh make_random_skin(Random& random, const RandomSkin& wanted);

/// Bones with random rotations, up to half a metre away; with `scale` > 1 also scaled unevenly by
/// up to that factor and sheared, some of them mirrored.
[[nodiscard]] std::vector<Affine3d> random_palette(Random& random, std::uint32_t slots,
                                                   double scale = 1.0);

/// In float, and the same values in double.
[[nodiscard]] std::vector<Affine3f> in_float(const std::vector<Affine3d>& palette);
[[nodiscard]] std::vector<Affine3d> in_double(const std::vector<Affine3f>& palette);

}  // namespace sunder::test
