#include "io/robot/internal/planar_axes.h"

namespace sunder::robot {

PlanarAxes planar_axes(const Vec3d& normal) {
  // The shortest turn from z to n is I + [v] + [v]² / (1 + n.z), with v = z × n.
  if (normal.z() < -1.0 + 1e-12) return {Vec3d(1, 0, 0), Vec3d(0, -1, 0)};
  const double factor = 1.0 / (1.0 + normal.z());
  const double xy = -normal.x() * normal.y() * factor;
  return {Vec3d(1.0 - normal.x() * normal.x() * factor, xy, -normal.x()),
          Vec3d(xy, 1.0 - normal.y() * normal.y() * factor, -normal.y())};
}

}  // namespace sunder::robot
