#include "tear/filling/room_below.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::tear {

bool RoomBelow::touches(Index triangle, const Vec3d& place, double near) const {
  const Index* points = &work_.editor.surface().corner_point[3 * triangle];
  return std::any_of(points, points + 3, [&](Index point) {
    return squared_norm(work_.posed.position(work_.editor, point) - place) <= near * near;
  });
}

bool RoomBelow::is_own(Index triangle) const {
  const TriangleRef ref = work_.editor.surface().triangle(triangle);
  if (ref.source_triangle < work_.editor.source().meshes[ref.mesh].triangle_count()) return false;
  const Index group = work_.editor.fillings.group(ref.mesh, ref.source_triangle);
  return std::ranges::any_of(
      own_, [&](const FillingSubmesh& of) { return of.mesh == ref.mesh && of.group == group; });
}

double RoomBelow::along(const Vec3d& place, const Vec3d& way) {
  constexpr int kMostTouching = 16;
  const double length = norm(way);
  double from = kBelowLipWays;
  for (int i = 0; i < kMostTouching && from < 1; ++i) {
    const auto hit = near_.first_hit({place + from * way, place + way});
    if (!hit) return 1;
    const double at = norm(hit->position - place) / length;
    if (!touches(hit->triangle, place, kBelowLipWays * length) && !is_own(hit->triangle))
      return std::min(at, 1.0);
    from = std::max(at, from) + kBelowLipWays;
  }
  return std::min(from, 1.0);
}

}  // namespace sunder::tear
