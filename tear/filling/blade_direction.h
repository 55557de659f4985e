#pragma once

#include <sunder/operation/operation.h>

#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// Distance of a point from a blade, squared.
[[nodiscard]] double squared_distance(const Blade& blade, const Vec3d& point);

/// The directions of the blades of a stroke. Runs of consecutive blades have boxes, so that only
/// blades near a place are looked at: a stroke goes on for thousands of them.
class BladeDirections {
 public:
  BladeDirections(const Stroke& stroke, ScratchMemory& scratch);

  /// The direction of the blades near a place, weighted by the inverse fourth power of their
  /// distances, so that it varies smoothly from one blade to the next. Runs that are eight times as
  /// far as the nearest blade are left out.
  [[nodiscard]] Vec3d at(const Vec3d& place);

 private:
  struct Run {
    Vec3d least, most;
    bool is_measured = false;  ///< From the current place.
    [[nodiscard]] double squared_distance(const Vec3d& place) const {
      return squared_norm(Vec3d((least - place).cwiseMax(place - most).cwiseMax(0.0)));
    }
  };
  [[nodiscard]] std::span<const Blade> blades_of(std::size_t run) const;

  double measure(std::size_t run, const Vec3d& place);

  const Stroke& stroke_;
  ScratchVector<Run> runs_;
  ScratchVector<double> squared_;  ///< Per blade of a run that is measured: squared distances.
};

}  // namespace sunder::tear
