#pragma once

#include "particles/front/marks.h"
#include "particles/front/surface_front.h"

namespace sunder::particles {

/// The nearest entry of a chain to a point of a band.
struct BesideLip {
  Index chain = 0, place = 0;
};

/// Memory that repairs reuse.
struct RepairScratch {
  SurfaceFront front;             ///< From the seed of one particle.
  SurfaceFront band_front;        ///< From the lips: each settle() continues it.
  std::vector<BesideLip> beside;  ///< Per point that band_front has reached.
  Marks worked;                   ///< Points that the current call changes.
  std::vector<Index> work_of;     ///< Per such point, its entry in StructureEdit.
  Marks logged_points;            ///< Points that the current change has logged.
  Marks logged_particles;
  Marks seen, given;
  Marks scored;  ///< Particles next to the lips.
  std::vector<Index> score_of;
  Marks has_area_change;  ///< Particles whose cell the current call changes.
  std::vector<double> area_change;

  /// Makes room for new points, by an eighth at a time.
  void make_room(std::size_t points) {
    if (beside.size() < points) beside.resize(points + points / 8 + 1024);
    if (work_of.size() < points) work_of.resize(points + points / 8 + 1024);
    front.grow(points);
    band_front.grow(points);
    for (Marks* marks : {&worked, &logged_points, &seen, &given}) marks->grow(points);
  }
};

}  // namespace sunder::particles
