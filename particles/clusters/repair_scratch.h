#pragma once

#include <sunder/particles/particle_set.h>

#include <vector>

#include "particles/front/marks.h"
#include "particles/front/surface_front.h"

namespace sunder::particles {

/// The nearest entry of a chain to a point of a band.
struct BesideLip {
  Index chain = 0, place = 0;
};

/// A point that a front has met.
struct MetPoint {
  Index point = 0;
  float distance = 0;
};

/// The arrays of a StructureEdit. The next step of settling uses their memory again, which costs
/// less than to get a megabyte from the system in each frame.
struct EditArrays {
  /// A point of the edit, and its range in `memberships`.
  struct Work {
    Index point = 0;
    Index first = 0, count = 0, room = 0;
    Index owner = kNone;  ///< Before the edit.
  };
  /// A point that a particle gained or lost.
  struct Counted {
    Index particle, point;
    int sign;
  };
  std::vector<Work> works;
  std::vector<ParticleMembership> memberships;
  std::vector<Counted> counted, by_particle;
  std::vector<Index> first_of_particle;  ///< In `by_particle`.

  void clear() {
    works.clear();
    memberships.clear();
    counted.clear();
  }
};

/// Memory that repairs reuse.
struct RepairScratch {
  SurfaceFront front;             ///< From the seed of one particle.
  std::vector<MetPoint> met;      ///< By `front`, if it is that of a point that is not covered.
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
  EditArrays edit;  ///< Empty unless there is work for settle().

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
