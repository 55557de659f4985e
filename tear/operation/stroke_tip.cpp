#include "tear/operation/stroke_tip.h"

#include <utility>

#include "tear/internal/surface.h"
#include "tear/path/wall_path.h"

namespace sunder::tear {

bool StrokeTip::is_on_surface(const Workpiece& work) const {
  return point != kNone && work.editor.surface().point_corner[point] != kNone;
}

std::optional<SurfaceHit> find_contact(const BladePlane& plane, double progress,
                                       const Workpiece& work, StrokeTip& tip) {
  std::optional<SurfaceHit> contact;
  if (const auto hit = std::exchange(tip.hit, std::nullopt); hit && progress == 0)
    contact = contact_at(*hit, plane, work.editor, work.posed);
  if (!contact) contact = first_contact(plane, progress, work.editor, work.posed);
  if (!contact || !work.editor.is_wall(contact->triangle)) return contact;
  // Seen along the blade, the opposite lip hides the lower part of a wall.
  const auto beside =
      first_contact(plane, progress, work.editor, work.posed, ContactWith::all_but_walls);
  const bool is_lip =
      beside && plane.project(beside->position).y() <
                    lowest_of_wall(plane, contact->triangle, work.editor, work.posed);
  return is_lip ? beside : contact;
}

}  // namespace sunder::tear
