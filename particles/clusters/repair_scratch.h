#pragma once

#include "particles/front/marks.h"

namespace sunder::particles {

/// Memory that one repair leaves to the next.
struct RepairScratch {
  Marks worked;                ///< Points that the call under way changes.
  std::vector<Index> work_of;  ///< Of those: which of its works.
  Marks logged_points;         ///< That the change under way has noted.
  Marks logged_particles;
  Marks seen, given;
  Marks scored;  ///< Particles that are beside the lips.
  std::vector<Index> score_of;
};

}  // namespace sunder::particles
