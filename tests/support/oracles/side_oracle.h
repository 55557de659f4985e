#pragma once

#include <array>
#include <string>

#include "support/models/solids.h"

namespace sunder::test {

/// The volume and the area that a body must have left on one side of a plane that cuts it.
struct ExactSide {
  double volume = 0;
  /// Without and with the section. They differ if the body has faces that lie in the plane within
  /// rounding: the least area has each of them on the side of the material behind it; the most has
  /// them exactly clipped, as they are rounded.
  double least_area = 0, most_area = 0;
  double least_capped_area = 0, most_capped_area = 0;
};

struct ExactSides {
  std::array<ExactSide, 2> sides;  ///< Below the plane, above it.
  double volume = 0, area = 0;     ///< Of the whole body.
};

/// Clips each triangle by itself, in double, without any topology: areas by summing, the section's
/// by the area vectors that close each side, volumes by the divergence theorem.
/// @param normal  unit length.
ExactSides exact_sides(const Solid& body, const Vec3d& point, const Vec3d& normal);

/// Compares the surface that a program left on one side with the exact one: area and volume within
/// 1e-6 of those of the whole body, closed and oriented (each directed edge as often as the
/// opposite one).
/// @param is_capped  false: the section is open, and only the area is compared.
/// @return what is wrong; empty if nothing is.
std::string fault_of_side(const Solid& surface, bool is_capped, std::size_t side,
                          const ExactSides& exact, const Vec3d& point);

}  // namespace sunder::test
