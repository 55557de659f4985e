#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// One lip of a tear: its points in order along the border, with the face on their left. Lengths in
/// metres.
struct LipChain {
  Side side = Side::left;
  float length = 0;  ///< Between its tips; infinite where an end leaves the surface or the chain
                     ///< closes a circle.
  struct Place {
    Index point = 0;
    float along = 0;   ///< From the first point of the chain.
    float to_tip = 0;  ///< Along the border to the nearer tip.
  };
  std::vector<Place> places;
  float depth = 0;  ///< How far from the lip its band reaches.

  /// A particle that moves this lip alone. It reaches as far as the band is deep, and `half_width`
  /// to either side along the lip.
  struct OfLip {
    Index particle = 0;
    float along = 0, half_width = 0;
  };
  std::vector<OfLip> particles;
};

/// The surface next to the lips of a tear, from the lips outwards, where particles of one side fade
/// out towards the other.
struct Band {
  Index tear = 0;
  std::vector<LipChain> chains;
  std::vector<Index> lips;     ///< The points from which the chains were found.
  std::vector<Index> pending;  ///< Lips of the same tear whose band was begun and left, to begin
                               ///< the stroke's next one; repeated.
  /// Particles to be regrown from their seeds when the band is complete; ascending.
  std::vector<Index> to_grow;
  Index growing = kNone;  ///< The particle that RepairScratch::band_front grows, after the band.
};

}  // namespace sunder::particles
