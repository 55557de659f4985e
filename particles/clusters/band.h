#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// One side of a tear: its points in order along the border, face to their left.
struct LipChain {
  Side side = Side::left;
  float length = 0;  ///< Between its tips, metres; infinite where an end runs out of the surface or the chain closes a circle.
  struct Place {
    Index point = 0;
    float along = 0;   ///< From the chain's first point.
    float to_tip = 0;  ///< Along the border to the nearer tip.
  };
  std::vector<Place> places;
  float depth = 0;  ///< How far from the lip its band reaches.

  /// A particle that moves this lip alone. It reaches as far as the band is deep, and along the lip half of `width` to either side.
  struct OfLip {
    Index particle = 0;
    float along = 0, half_width = 0;
  };
  std::vector<OfLip> particles;
};

/// The surface beside the lips of a tear, from the lips on: where particles of the one side end at the other.
struct Band {
  Index tear = 0;
  std::vector<LipChain> chains;
  std::vector<Index> to_grow;  ///< Particles that are to be grown anew when the band is done; ascending.
};

}  // namespace sunder::particles
