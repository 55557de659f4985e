#include "tear/operation/stroke_tip.h"

#include <utility>

#include "tear/internal/surface.h"

namespace sunder::tear {

bool StrokeTip::is_on_surface(const Workpiece& work) const {
  return point != kNone && work.editor.surface().point_corner[point] != kNone;
}

std::optional<SurfaceHit> find_contact(const BladePlane& plane, double progress,
                                       const Workpiece& work, StrokeTip& tip) {
  if (const auto hit = std::exchange(tip.hit, std::nullopt); hit && progress == 0)
    if (const auto contact = contact_at(*hit, plane, work.editor, work.posed)) return contact;
  return first_contact(plane, progress, work.editor, work.posed);
}

}  // namespace sunder::tear
