#include "tear/filling/room_below.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/path/entry.h"

namespace sunder::tear {
namespace {

bool touches(Index triangle, const Vec3d& place, double near, const Workpiece& work) {
  const Index* points = &work.editor.surface().corner_point[3 * triangle];
  return std::any_of(points, points + 3, [&](Index point) {
    return squared_norm(work.posed.position(work.editor, point) - place) <= near * near;
  });
}

bool is_of(std::span<const FillingSubmesh> submeshes, Index triangle, const Workpiece& work) {
  const TriangleRef ref = work.editor.surface().triangle(triangle);
  if (ref.source_triangle < work.editor.source().meshes[ref.mesh].triangle_count()) return false;
  const Index group = work.editor.fillings.group(ref.mesh, ref.source_triangle);
  return std::ranges::any_of(submeshes, [&](const FillingSubmesh& of) {
    return of.mesh == ref.mesh && of.group == group;
  });
}

}  // namespace

double room_below(const Vec3d& place, const Vec3d& way, std::span<const FillingSubmesh> own,
                  const Workpiece& work) {
  constexpr int kMostTouching = 16;
  const double length = norm(way);
  double from = kBelowLipWays;
  for (int i = 0; i < kMostTouching && from < 1; ++i) {
    const auto hit = first_hit_of_many({place + from * way, place + way}, work.editor, work.posed);
    if (!hit) return 1;
    const double at = norm(hit->position - place) / length;
    if (!touches(hit->triangle, place, kBelowLipWays * length, work) &&
        !is_of(own, hit->triangle, work))
      return std::min(at, 1.0);
    from = std::max(at, from) + kBelowLipWays;
  }
  return std::min(from, 1.0);
}

}  // namespace sunder::tear
