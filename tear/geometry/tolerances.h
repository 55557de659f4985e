#pragma once

namespace sunder::tear {

/// Sweep coordinates that differ by less denote the same place: rounding of the inverse bilinear
/// map.
inline constexpr double kSamePlace = 1e-9;

/// A curve goes forward if its progress in the sweep grows by more than this.
inline constexpr double kLeastAdvance = 1e-12;

/// A place nearer to an end of an edge than this fraction of the edge's length snaps to that end.
/// It moves the path by less than is visible.
inline constexpr double kSnap = 1e-3;

/// The same for edges that tears made, as a fraction of the longest side of the adjacent faces. A
/// nearer place would leave a sliver. Tears made these faces small, so the path still moves by
/// little.
inline constexpr double kSliver = 3e-2;

/// The least snapping distance, for outlines of gaps, as a fraction of the edge's length: less than
/// rounding shows.
inline constexpr double kTightSnap = 1e-9;

static_assert(kTightSnap < kSnap && kSnap < kSliver);

}  // namespace sunder::tear
