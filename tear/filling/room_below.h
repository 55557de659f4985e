#pragma once

#include <span>

#include "tear/filling/wall_ends.h"
#include "tear/path/faces_near_blades.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// How far the posed surface is from places of it, along ways into the body.
class RoomBelow {
 public:
  /// @param own  walls of the same stroke, which do not count; nor do faces that touch a place.
  RoomBelow(std::span<const FillingSubmesh> own, const Workpiece& work)
      : own_(own), work_(work), near_(work) {}

  /// Forgets the ways.
  void clear() { near_.clear(); }
  /// Nothing is searched beyond the end of a way.
  void expect(const Vec3d& place, const Vec3d& way) { near_.include({place, place + way}); }
  /// Looks around the ways that are expected.
  void look_around() { near_.collect(); }
  /// Looks around a place that was expected, with its ways.
  void stand_at(const Vec3d& place, const Vec3d& way, const Vec3d& other) {
    near_.select(std::array{Blade{place, place + way}, Blade{place, place + other}});
  }
  /// The room along a way of the place of stand_at(): a fraction of it, at most 1.
  [[nodiscard]] double along(const Vec3d& place, const Vec3d& way);

 private:
  [[nodiscard]] bool touches(Index triangle, const Vec3d& place, double near) const;
  [[nodiscard]] bool is_own(Index triangle) const;

  std::span<const FillingSubmesh> own_;
  const Workpiece& work_;
  FacesNearBlades near_;
};

}  // namespace sunder::tear
