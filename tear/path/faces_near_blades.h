#pragma once

#include <sunder/operation/operation.h>

#include <array>
#include <optional>
#include <span>

#include "tear/path/blade_segment.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// Finds where many short blades near one another first meet the posed surface. The faces near them
/// are collected once, each with a box in float around it, and those near a few of the blades are
/// selected from them, so that a blade is compared with few faces.
class FacesNearBlades {
 public:
  explicit FacesNearBlades(const Workpiece& work);

  /// Forgets the blades and the faces.
  void clear();
  /// Makes the region of collect() include a blade.
  void include(const Blade& blade);
  /// Collects the live faces near the blades that were included. They become outdated when the
  /// surface changes.
  void collect();
  /// Selects the faces that first_hit() looks at: those near some of the blades.
  void select(std::span<const Blade> blades);
  /// As first_hit(), for a part of one of the blades of select().
  [[nodiscard]] std::optional<SurfaceHit> first_hit(const Blade& blade);

 private:
  /// The low corner of a box and its negated high corner, relative to origin_, so that a box is
  /// beside another if one of its numbers is greater than that of the other's opposite.
  using Box = std::array<float, 6>;

  /// A face that was selected once: neighbouring blades select the same ones.
  struct Known {
    Index face = kNone;
    FaceCorners corners;
    Vec3d normal;         ///< Of any length.
    double on_plane = 0;  ///< Products with the normal that rounding may have made.

    /// Whether a blade is on one side of the plane.
    [[nodiscard]] bool is_beside(const Blade& blade) const;
  };

  [[nodiscard]] Box relative(const Vec3d& low, const Vec3d& high) const;
  void add_face(Index face);
  /// Sets is_near_ for the faces whose boxes meet another box.
  void compare(const Box& box);
  /// The first face from `from` on that is near; the number of faces if there is none.
  [[nodiscard]] std::size_t next_near(std::size_t from) const;
  [[nodiscard]] Known know(Index face) const;

  const Workpiece& work_;
  Vec3d frame_origin_;  ///< Of the queries of this operation.
  Vec3d low_, high_;    ///< Of the blades.
  Vec3d origin_;        ///< Amid the blades.
  double margin_ = 0;   ///< Of the blades.
  ScratchVector<Index> faces_;
  std::array<ScratchVector<float>, 6> boxes_;  ///< The numbers of the faces' boxes, one by one.
  ScratchVector<unsigned char> is_near_;       ///< Per face.
  ScratchVector<Index> places_;                ///< Per face: in known_, or kNone.
  ScratchVector<Known> known_;
  ScratchVector<Index> selected_;  ///< Places in known_.
  ScratchVector<Index> crossed_;   ///< Those that the blade of first_hit() crosses.
};

}  // namespace sunder::tear
