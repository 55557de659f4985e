#pragma once

namespace sunder::particles {

// Tolerances of the module, in one place. Each name ends with the unit or the base of its value:
// "ranges" are those of the particle concerned, "reach" is a distance from a seed as a fraction of
// the particle's range. docs/method/particles.md lists them.

// ---- Coverage of the surface.

/// A point whose nearest seed of a lip is farther than this gets a lip particle.
inline constexpr float kLipCoveredReach = 0.8f;
/// Seeds are at least this far apart. Less than 1, so that weights overlap and every point has more
/// than one particle where it fades.
inline constexpr float kSeedSpacingReach = 0.85f;
/// A point without a particle nearer than this gets one of its own; it would otherwise be where all
/// its particles fade.
inline constexpr float kUncoveredReach = 0.97f;
static_assert(kLipCoveredReach < kSeedSpacingReach && kSeedSpacingReach < kUncoveredReach &&
              kUncoveredReach < 1);

// ---- Small particles next to a tip, in multiples of their spacing along the lip.

/// Spacing of the particles of a lip near a tip, in ranges.
inline constexpr float kLipSpacingRanges = 0.3f;
/// A lip has at least this many particles between two tips, if the mesh is fine enough.
inline constexpr float kLeastPerLip = 12;
/// Least spacing, in mean lengths of the mesh's edges: fewer cannot show a smooth gap.
inline constexpr float kLeastSpacingEdges = 2;
/// Farther from a tip than this, the gap changes so little that large particles suffice.
inline constexpr float kNearTipRanges = 2;
/// Range of the last particle of a lip, next to the tip.
inline constexpr float kTipRangeSpacings = 0.65f;
/// A mesh so coarse that the spacing would be more than this has no small particles.
inline constexpr float kMostSpacingRanges = 0.5f;
/// Range of the other particles of a lip, and spacing and distance from the lip of those next to
/// them. Found by trial: with these, gaps are nearest to those of finite elements.
inline constexpr float kLipRangeSpacings = 1.3f, kRowSpacings = 1.3f, kRowDistanceSpacings = 0.86f;
static_assert(kLipRangeSpacings > kRowDistanceSpacings,
              "other particles fade out within the reach of those of the lip");

// ---- Cells.

/// Two seeds whose path across their border is longer than this multiple of their distance are on
/// both sides of a slit. On an unbroken surface it is below 2 / kSeedSpacingReach.
inline constexpr double kBentPath = 2.5;
static_assert(kBentPath > 2 / kSeedSpacingReach);
/// The greatest coupling of such seeds next to one tip. Around a short slit their border has two
/// parts, at both tips, whose middle is in the slit, so the path by it is much too short; then
/// their coupling is the second value.
inline constexpr double kMostBentCoupling = 3, kTwoTipsCoupling = 1;
static_assert(kTwoTipsCoupling < kMostBentCoupling);
/// A face whose doubled area is below this fraction of its longest squared edge has no reliable
/// angles.
inline constexpr double kNeedleFraction = 1e-6;
/// The least part of a coupling that is left where the reach of the tissue, sqrt(S / (rho k)), is
/// shorter than half of the distance between seeds.
inline constexpr double kLeastCoupledPart = 0.1;
/// Coupling of a particle whose seed is in the cell of another one to that one: about that of two
/// usual neighbours, which is much more than its foundation.
inline constexpr double kCrowdedCoupling = 1;
/// Least area of a cell as a part of the squared range, so that every particle has a mass: also
/// those of walls and caps, and those to whose seed no point is nearest.
inline constexpr double kLeastCellArea = 0.01;

// ---- Threads of sutures.

/// A thread that is longer than this pulls with all of its tension.
inline constexpr double kTautRanges = 1e-3;
/// A change of a thread's length that wakes tissue at its ends, in such lengths.
inline constexpr double kFeltThreadLengths = 0.5;

// ---- Sleep. Bound particles (held, touched, at a stretch limit) and their neighbours are pulled
// away and pushed back in every step, so they never stop moving a little.

inline constexpr double kQuietRanges = 1e-4;
inline constexpr double kAtRestRanges = 2e-4;
inline constexpr double kFeltRanges = 5e-4;
inline constexpr double kQuietBoundRanges = 6e-3;
inline constexpr double kFeltBoundRanges = 9e-3;
inline constexpr double kQuietRangesPerSecond = 1e-3;
inline constexpr double kQuietSeconds = 0.5;
/// After kPatientSeconds without a change from outside, the tolerances of bound particles grow by
/// themselves every kTiringSeconds, up to kMostTolerance times.
inline constexpr double kPatientSeconds = 2;
inline constexpr double kTiringSeconds = 1;
inline constexpr double kMostTolerance = 12;
static_assert(kQuietRanges < kAtRestRanges && kAtRestRanges < kFeltRanges,
              "a sleeping particle must not wake at once");
static_assert(kQuietBoundRanges < kFeltBoundRanges, "a sleeping particle must not wake at once");

// ---- Bodies in a Bullet world.

/// A particle that swings or creeps by less than this may sleep.
inline constexpr double kBulletStillRanges = 2e-3;
/// A change of the springs' pull that wakes a body, in multiples of kBulletStillRanges.
inline constexpr double kBulletWakesStills = 2;
static_assert(kBulletWakesStills > 1);

// ---- Contact.

/// Contact points deeper than this are pushed out.
inline constexpr double kContactDepthRanges = 1e-3;
/// Points nearer to a collider than this may be pushed in by the contacts of their neighbours.
inline constexpr double kContactMarginRanges = 0.25;
/// Upper bound of the distance of members from the centroid, per unit of RestMotion::size() (root
/// of 3 where the pose changes no length): at most two ranges.
inline constexpr double kMemberRanges = 1.2;
static_assert(kContactDepthRanges < kContactMarginRanges && kContactMarginRanges < kMemberRanges);

// ---- Stretch limits, relative to the length that a limit allows.

inline constexpr double kStretchExcess = 1e-4;
/// A particle that fell asleep at its limit wakes only for more than this.
inline constexpr double kStretchWakesExcess = 1e-2;
/// Sweeps over velocities end where pairs part slower than this fraction of the fastest pair.
inline constexpr double kStretchStoppedFraction = 1e-3;
static_assert(kStretchExcess < kStretchWakesExcess);

// ---- Tearing by force.

/// A tear continues if the cosine of the angle between its last edge and its direction is at least
/// this.
inline constexpr double kLeastForwardCosine = 0.2;
/// Radius of the disc around a tip in which its load is measured, in spacings of the small
/// particles, and the part of it next to the tip whose displacements do not count. In a smaller
/// disc the blending of the particles shows; a larger one costs more and hardly gains.
inline constexpr double kTipDiscSpacings = 6, kTipCorePart = 0.25;
/// Where the surface around a tip has a smaller angle, radians, a gap ends bluntly.
inline constexpr double kSharpTipAngle = 5;
/// Tissue whose plane turned by more than the angle of this cosine, 150 degrees, was pressed
/// through itself.
inline constexpr double kPressedThroughCosine = -0.8660254037844387;
/// Neighbours are in a row if the determinant of their moments is below this fraction of the
/// squared trace.
inline constexpr double kRowDeterminantFraction = 1e-4;

/// A strain below this, times the distance from the origin by that of a particle's neighbours, is
/// the rounding of positions.
inline constexpr double kRoundedStrain = 1e-6;

// ---- Solvers.

/// Least compliance of a hold, as a fraction of that of the tissue it pulls. A stiffer hold would
/// act the same, but forces of holds against one another would lose their digits.
inline constexpr double kLeastCompliance = 1e-12;
/// Squared residual of the springs between bodies in a Bullet world, which have single precision,
/// relative to the right-hand side.
inline constexpr double kBulletSquaredResidual = 1e-12;
/// A linear map of unit norm whose determinant is below this is singular: it has no rotation and no
/// inverse.
inline constexpr double kFlatDeterminant = 1e-9;

// ---- Gradients of weights.

/// Faces around a point whose mean normal is shorter than this make a crease.
inline constexpr double kCreaseCosine = 0.9;
/// Weight of a gradient across the mean of a crease's faces, which hardly any of them knows.
inline constexpr double kAcrossCrease = 0.05;

// ---- Steps.

/// The square of a shorter step is too small to divide by, and forces have no visible effect in it.
inline constexpr double kShortestStepSeconds = 1e-100;
inline constexpr double kLongestStepSeconds = 3600;
static_assert(kShortestStepSeconds < kLongestStepSeconds);

}  // namespace sunder::particles
