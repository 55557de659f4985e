#pragma once

#include <array>

#include "support/machine/random.h"
#include "support/models/solids.h"

namespace sunder::test {

/// Where a plane passes a body.
enum class PlaneFamily : std::uint8_t {
  anywhere,
  near_vertex,  ///< At 1e-9 to 1e-3 sizes from one.
  through_vertex,
  along_edge,
  through_ring,  ///< Of vertices around the body, without faces in it.
  in_face,
};
inline constexpr std::array kPlaneFamilies = {PlaneFamily::anywhere,       PlaneFamily::near_vertex,
                                              PlaneFamily::through_vertex, PlaneFamily::along_edge,
                                              PlaneFamily::through_ring,   PlaneFamily::in_face};
const char* name_of(PlaneFamily family);

/// A closed body and a plane that is hard to cut it by.
struct HardCut {
  const char* body_name = "";
  Solid body;  ///< Connected, a manifold; its coordinates are floats.
  Vec3d point = Vec3d::Zero(), normal = Vec3d(0.0, 0.0, 1.0);  ///< Unit length.
};

/// Boxes, prisms, tubes, balls, convex hulls and unions of boxes, randomly placed and rounded to
/// float, so that no face is parallel to an axis and vertices that were in one plane are so within
/// rounding. The plane is computed in double from the rounded vertices, or in float.
HardCut random_hard_cut(PlaneFamily family, Random& random);

}  // namespace sunder::test
