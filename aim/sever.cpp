#include <algorithm>
#include <cmath>
#include <numbers>

#include "aim/limb_sections.h"
#include "aim/operations.h"
#include "aim/view.h"
#include "core/internal/ordered.h"

namespace sunder::aim {
namespace {

constexpr double kPi = std::numbers::pi;
/// A plane that leans more is nearly along the bone: 80 degrees.
constexpr double kMostTilt = 80 * kPi / 180;

/// The middle of the section's longest line: it lies on this section and, unless surfaces coincide,
/// on no other.
Vec3d place_on(const Section& section) {
  const auto longest = std::max_element(section.lines.begin(), section.lines.end(),
                                        [](const Section::Line& a, const Section::Line& b) {
                                          return squared_norm(a.ends[1] - a.ends[0]) <
                                                 squared_norm(b.ends[1] - b.ends[0]);
                                        });
  return 0.5 * (longest->ends[0] + longest->ends[1]);
}

/// The bone's direction, leaning towards the view by the tilt.
Result<Vec3d> normal_of(const Limb& limb, const SeverOperation& sever) {
  if (sever.tilt == 0) return limb.segment.direction();
  if (!(std::abs(sever.tilt) <= kMostTilt))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "%s: the tilt is %g degrees; expected at most 80", limb.label.c_str(),
                           sever.tilt * 180 / kPi);
  const Result<ViewFrame> frame = view_frame(limb, sever.from);
  if (!frame) return frame.error();
  return Vec3d(std::cos(sever.tilt) * frame->along + std::sin(sever.tilt) * frame->towards_viewer);
}

}  // namespace

Result<Operation> resolve_sever(const PosedSurface& surface, const SeverOperation& sever) {
  const Result<Limb> limb = find_limb(surface, sever.place);
  if (!limb) return limb.error();
  const Result<Vec3d> normal = normal_of(*limb, sever);
  if (!normal) return normal.error();
  const auto sections = limb_sections(*limb, {*normal, dot(*normal, limb->place)});
  if (!sections) return sections.error();
  PlaneCut cut;
  cut.point = limb->place;
  cut.normal = *normal;
  cut.caps = sever.caps;
  for (const Section& section : *sections) cut.sections.push_back(place_on(section));
  cut.weights = sever.weights;
  return Operation(CutOperation{sever.pose, cut});
}

}  // namespace sunder::aim
