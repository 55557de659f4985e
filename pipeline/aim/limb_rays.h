#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/aim/limb_sections.h"
#include "pipeline/aim/view.h"

namespace sunder::aim {

/// A face that a ray meets, and the height of the place.
struct MetFace {
  double height = 0;
  Index face = kNone;
};

/// The surfaces that a ray from the viewer meets. Heights are towards the viewer, from the plane
/// of the view through the place that the rays are measured from.
struct RayHit {
  double near = 0, far = 0;  ///< First and last surface of the limb.
  Index near_face = kNone;
  // Distances to the next surface that is not this part of the limb, or infinity.
  double free_before = 0;  ///< From `near` towards the viewer.
  double free_below = 0;  ///< From `near` away from the viewer, to one that the limb does not move.
  double free_behind = 0;  ///< From `far` away from the viewer.
};

/// Where rays hit one face after the other.
struct HitHeights {
  std::vector<MetFace> facing;   ///< Of the limb, towards the viewer.
  std::vector<MetFace> averted;  ///< Of the limb, away from the viewer.
  std::vector<MetFace>
      kin;  ///< Of other surfaces that the limb moves: eyes, teeth, a bent forearm.
  std::vector<MetFace> others;  ///< Of the rest.
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
  /// The ray through the middle, which meets the sections. @return empty where none is seen.
  [[nodiscard]] std::optional<RayHit> cast_at_middle() const;
  /// Another ray. Of several parts of the limb one behind the other, such as an arm before the
  /// chest, it meets the one that continues its neighbour's.
  /// @param offset  in the plane of the view. @return empty where the ray misses the limb.
  [[nodiscard]] std::optional<RayHit> cast(const Vec3d& offset, const RayHit& neighbour) const;
  /// The weights of the limb and of others at the place where a ray meets the near surface.
  [[nodiscard]] LimbShares shares_at(const Vec3d& offset, const RayHit& hit) const;
  /// Whether a ray meets a surface that the limb does not move between two heights.
  [[nodiscard]] bool meets_others(const Vec3d& offset, double low, double high) const;

 private:
  [[nodiscard]] bool is_moved_by_limb(Index face) const;
  [[nodiscard]] bool may_belong(Index face, double reach) const;
  /// @param is_limb  per face; the others that the limb moves are kin.
  [[nodiscard]] HitHeights all_hits(const Vec3d& offset, const std::vector<bool>& is_limb) const;
  [[nodiscard]] RayHit hit_at(const MetFace& near, double far, const HitHeights& hits) const;

  const Limb& limb_;
  ViewFrame frame_;
  std::vector<Index> section_faces_;
  std::vector<bool> is_of_section_;  ///< Per face.
  Vec3d middle_ = Vec3d::Zero();
  double width_ = 0;
  std::vector<bool> is_of_limb_;  ///< Per face.
};

}  // namespace sunder::aim
