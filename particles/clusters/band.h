#pragma once

#include <algorithm>
#include <cmath>

#include "particles/clusters/structure.h"
#include "particles/internal/tolerances.h"

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
  float depth = 0;    ///< How far from the lip its band reaches.
  float spacing = 0;  ///< Of its small particles near tips; 0: it gets none.

  struct End {
    Index tip = kNone;    ///< One edge from the end; kNone: the chain ends elsewhere.
    Index other = kNone;  ///< The chain of the other lip that ends there; kNone: none in the band.
    float distance = 0;   ///< To the tip, along the border; infinite if none is near.
  };
  End front, back;

  /// A particle that moves this lip alone.
  struct OfLip {
    Index particle = 0;
    float along = 0;
    /// To either side along the lip. A small one reaches as far into the surface, a large one as
    /// far as the band is deep.
    float half_width = 0;
    bool is_small = false;
  };
  std::vector<OfLip> particles;

  /// Whether small particles move the lip at a place, and how much: from 1 to 0 with the distance
  /// from the tip. @param range  of the decomposition, metres.
  [[nodiscard]] float fineness(const Place& place, float range) const {
    if (!(spacing > 0)) return 0;
    return std::isfinite(length)
               ? 1.0f
               : std::clamp(2 * (kNearTipRanges - place.to_tip / range), 0.0f, 1.0f);
  }
};

/// Lips of a tear next to which particles still have to fade out.
struct PendingLips {
  Index tear = 0;
  std::vector<Index> points;  ///< Repeated, in no order; some may be gone.
};

/// The work that follow() leaves to settle(), without what is known about its progress.
struct PendingWork {
  std::vector<PendingLips> lips;  ///< The last is handled first.
  /// Particles to be regrown from their seeds when all bands are complete; ascending.
  std::vector<Index> to_grow;

  [[nodiscard]] bool empty() const { return lips.empty() && to_grow.empty(); }
};

/// The surface next to the lips of a tear, from the lips outwards, where particles of one side fade
/// out towards the other. RepairScratch::band_front has its front.
struct Band {
  Index tear = 0;
  std::vector<Index> lips;  ///< The points from which the chains are found.
  bool is_begun = false;    ///< Whether the chains were found.
  /// Whether the tear is complete. Lips of a stroke in progress have no small particles yet, which
  /// would be in the way of the next ones.
  bool is_final = false;
  std::vector<LipChain> chains;
  Index growing = kNone;  ///< After the band: the particle that the front grows.
  /// Members that the front did not reach, which the particle loses; the last first.
  std::vector<Index> unreached;
  bool is_grown = false;  ///< Whether `unreached` was found.
  /// Before the front goes on: a point that gets a particle of its own, and how many points the
  /// front of this particle has met, which RepairScratch::met lists.
  Index uncovered = kNone, met_count = 0;
  PendingWork pending;  ///< Other work, which follows.
};

}  // namespace sunder::particles
