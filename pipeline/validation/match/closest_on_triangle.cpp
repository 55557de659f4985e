#include "pipeline/validation/match/closest_on_triangle.h"

#include <algorithm>

#include "core/internal/ordered.h"

namespace sunder::validation {
namespace {

/// Barycentric coordinates of the closest place.
std::array<double, 3> closest_barycentric(const Vec3d& point, const Vec3d& a, const Vec3d& b,
                                          const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a, ap = point - a, bp = point - b, cp = point - c;
  const double ab_ap = dot(ab, ap), ac_ap = dot(ac, ap);
  if (ab_ap <= 0 && ac_ap <= 0) return {1, 0, 0};
  const double ab_bp = dot(ab, bp), ac_bp = dot(ac, bp);
  if (ab_bp >= 0 && ac_bp <= ab_bp) return {0, 1, 0};
  const double ab_cp = dot(ab, cp), ac_cp = dot(ac, cp);
  if (ac_cp >= 0 && ab_cp <= ac_cp) return {0, 0, 1};
  const double of_c = ab_ap * ac_bp - ab_bp * ac_ap;
  if (of_c <= 0 && ab_ap >= 0 && ab_bp <= 0) {
    const double t = ab_ap / (ab_ap - ab_bp);
    return {1 - t, t, 0};
  }
  const double of_b = ab_cp * ac_ap - ab_ap * ac_cp;
  if (of_b <= 0 && ac_ap >= 0 && ac_cp <= 0) {
    const double t = ac_ap / (ac_ap - ac_cp);
    return {1 - t, 0, t};
  }
  const double of_a = ab_bp * ac_cp - ab_cp * ac_bp;
  if (of_a <= 0 && ac_bp - ab_bp >= 0 && ab_cp - ac_cp >= 0) {
    const double t = (ac_bp - ab_bp) / ((ac_bp - ab_bp) + (ab_cp - ac_cp));
    return {0, 1 - t, t};
  }
  const double sum = of_a + of_b + of_c;
  if (!(sum > 0)) return {1, 0, 0};
  return {std::max(0.0, 1 - of_b / sum - of_c / sum), of_b / sum, of_c / sum};
}

}  // namespace

PlaceOnTriangle closest_on_triangle(const Vec3d& point, const Vec3d& a, const Vec3d& b,
                                    const Vec3d& c) {
  PlaceOnTriangle place;
  place.barycentric = closest_barycentric(point, a, b, c);
  const Vec3d closest = a + place.barycentric[1] * (b - a) + place.barycentric[2] * (c - a);
  place.distance = norm(closest - point);
  return place;
}

}  // namespace sunder::validation
