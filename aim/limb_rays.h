#pragma once

#include <optional>
#include <span>
#include <vector>

#include "aim/limb_sections.h"
#include "aim/view.h"

namespace sunder::aim {

/// What a ray from the viewer meets. Heights are towards the viewer, from the plane of the view
/// through the place that the rays are measured from.
struct RayHit {
  double near = 0, far = 0;  ///< First and last surface of the limb.
  double free_before = 0;    ///< From `near` to the next other surface, or infinity.
  double free_behind = 0;    ///< From `far` to the next other surface, or infinity.
};

/// Rays that look at a limb as the viewer does. Only the surface that is connected to the limb's
/// sections and moved by the limb counts as the limb, so that neither a hand before the chest nor
/// the other leg behind the first one is met.
class LimbRays {
 public:
  /// @param sections  of limb_sections(), across the limb.
  LimbRays(const Limb& limb, const ViewFrame& frame, std::span<const Section> sections);

  /// Seen width of the limb at the place, metres.
  [[nodiscard]] double width() const { return width_; }
  /// The middle of the limb at the place, as seen; the plane of the view goes through it.
  [[nodiscard]] const Vec3d& middle() const { return middle_; }

  /// Decides which faces are of the limb, up to a distance from the middle.
  void look_around(double reach);
  /// @param offset  in the plane of the view. @return empty where the ray misses the limb.
  [[nodiscard]] std::optional<RayHit> cast(const Vec3d& offset) const;

 private:
  [[nodiscard]] bool may_belong(Index face, double reach) const;

  const Limb& limb_;
  ViewFrame frame_;
  std::vector<Index> section_faces_;
  Vec3d middle_ = Vec3d::Zero();
  double width_ = 0;
  std::vector<bool> is_of_limb_;  ///< Per face.
};

}  // namespace sunder::aim
