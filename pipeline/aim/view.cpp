#include "pipeline/aim/view.h"

#include <cmath>

#include "core/internal/ordered.h"
#include "core/operation/internal/view_sides.h"
#include "pipeline/aim/facing.h"

namespace sunder::aim {
namespace {

/// Sine of the least angle between view and bone: 15 degrees.
constexpr double kLeastSine = 0.25;
/// The front of a model as it stands in a glTF file.
Vec3d front_of_files() {
  return kViewSides[static_cast<std::size_t>(ViewSide::front)].towards_viewer();
}

/// The direction towards the viewer, of any length.
Vec3d direction_of(const Limb& limb, const std::optional<View>& from) {
  if (!from) return default_direction(limb, front_of_files());
  if (const auto* const side = std::get_if<ViewSide>(&*from))
    return side_direction(*side, front_of_files());
  const ViewDirection& given = std::get<ViewDirection>(*from);
  return given.space == ViewDirection::Space::model
             ? given.direction
             : Vec3d(multiply(limb.surface.pose().model_from_bone[limb.bones.bone()].linear(),
                              given.direction));
}

}  // namespace

Vec3d ViewFrame::turned(double radians) const {
  // Counter-clockwise about the view: from `across` towards towards_viewer x across.
  return std::cos(radians) * across - std::sin(radians) * along;
}

Result<ViewFrame> view_frame(const Limb& limb, const std::optional<View>& from) {
  Vec3d direction = direction_of(limb, from);
  if (!direction.allFinite() || !(norm(direction) > 1e-30) || !(norm(direction) < 1e30))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "%s: the direction of the view has no length or is not finite",
                           limb.label.c_str());
  direction /= norm(direction);
  ViewFrame frame;
  frame.along = limb.segment.direction();
  const Vec3d beside = direction - dot(direction, frame.along) * frame.along;
  if (norm(beside) < kLeastSine)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "%s: the view is along the bone; give a side from which the limb is "
                           "seen across",
                           limb.label.c_str());
  frame.towards_viewer = beside / norm(beside);
  frame.across = frame.towards_viewer.cross(frame.along);
  return frame;
}

}  // namespace sunder::aim
