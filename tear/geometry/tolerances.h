#pragma once

#include "core/operation/internal/field_ranges.h"

namespace sunder::tear {

// Tolerances of the module, in one place. Each name ends with the unit or the base of its value:
//   Metres, Seconds, Radians
//   Edges         fraction of the length of the edge concerned
//   Sizes         fraction of the longest side of the face, polygon or box concerned
//   Areas         fraction of the area concerned
//   Lengths       fraction of the lengths from which a vector or distance is computed
//   Coordinates   fraction of the largest coordinate concerned
//   Terms         fraction of the sum of the magnitudes of the terms
//   Sweeps        sweep coordinates: a segment of a stroke has progress and depth 0 to 1
//   Barycentric   barycentric coordinates
//   Widths        fraction of the width of the gap
//   Cosine, Sine  of the angle concerned
// Bounds of rounding errors have wide margins. docs/method/tear.md lists all. The error bounds of
// exact predicates are derived where they stand: tear/section/exact_predicates.cpp.

// ---- Input.

// What logs and the command accept too stands with the ranges of their fields.
using sunder::kFarthestMetres;
using sunder::kLongestMetres;
using sunder::kLongestSeconds;
using sunder::kShortestMetres;
/// As kShortestMetres, for vectors that only give a direction, whatever their length.
inline constexpr double kShortestDirection = 1e-30;
/// Corners of a polygon may lie outside its sides by less: it still counts as convex.
inline constexpr double kConvexSizes = 1e-9;

// ---- The path of a blade.

/// Sweep coordinates that differ by less are of one place: rounding of the inverse bilinear map.
inline constexpr double kSamePlaceSweeps = 1e-9;
/// A curve goes forward if its progress grows by more.
inline constexpr double kLeastAdvanceSweeps = 1e-12;
/// Error of the roots by which a box is compared with the sweep.
inline constexpr double kRootSweeps = 1e-7;
static_assert(kSamePlaceSweeps < kRootSweeps, "no box may be ahead of a place in it");
/// The sweep's equation is linear where |a c| is at most this fraction of b squared.
inline constexpr double kLinearSquares = 1e-14;
/// A blade that moves across itself by less sweeps no plane.
inline constexpr double kSweptLengths = 1e-9;
/// A vector that is shorter than this fraction of those it comes from has no direction.
inline constexpr double kDirectionLengths = 1e-12;
/// A blade runs along a face if their triple product is below this fraction of the product of the
/// three lengths.
inline constexpr double kAlongFaceLengths = 1e-14;
/// A blade that passes a face by less hits it, so that none passes between two faces.
inline constexpr double kHitBarycentric = 1e-12;
/// Lines less steep than this give no bound across the blade.
inline constexpr double kSteepSine = 1e-6;
/// Axes are turned towards a second direction that differs by more.
inline constexpr double kAxisSine = 1e-3;

// ---- Welds.

/// Ends of lips that differ by less are one place: where a wound crosses both lips of another one,
/// each crossing is computed and rounded by itself. Snapping keeps other points much farther apart.
inline constexpr double kWeldBarycentric = 1e-6;

// ---- Snapping. A place that is nearer to an end of an edge snaps to it.

/// Outlines of gaps: less than rounding shows.
inline constexpr double kTightSnapEdges = 1e-9;
/// A path on edges of the source, and on heights of its faces: it moves by less than is visible.
/// Next to lips, in barycentric coordinates of the source triangle.
inline constexpr double kSnapEdges = 1e-3;
/// A path on edges that tears made, and its ends next to lips; the size is that of the adjacent
/// faces. A nearer place would leave a sliver. Tears made these faces small, so the path still
/// moves by little.
inline constexpr double kSliverSizes = 3e-2;
/// The farthest at which places that cannot be stored apart snap.
inline constexpr double kFarthestSnapEdges = 0.25;
static_assert(kTightSnapEdges < kSnapEdges && kSnapEdges < kSliverSizes &&
              kSliverSizes < kFarthestSnapEdges);
/// Places nearer than four units in the last place of a stored coordinate are stored as one.
inline constexpr double kStoredCoordinates = 0x1p-22;
/// A point is on the plane of a cut if a change of its stored coordinates by less moves it there.
inline constexpr double kOnPlaneCoordinates = 0x1p-23;
static_assert(kOnPlaneCoordinates < kStoredCoordinates);

// ---- Faces.

/// A face or polygon has no area if its doubled area is below this fraction of its squared size.
inline constexpr double kFlatSquaredSizes = 1e-12;
/// Smaller parts of an origin are not made: rounding of barycentric coordinates could turn them.
inline constexpr double kLeastOriginAreas = 1e-14;
/// Smaller parts of a face are not made: rounding of stored positions could turn them.
inline constexpr double kLeastFaceAreas = 1e-9;
static_assert(kLeastOriginAreas < kLeastFaceAreas, "a face is a part of its origin");
/// Another diagonal has to be better by this factor, so that rounding does not flip edges to and
/// fro.
inline constexpr double kBetterShapeFactor = 1.0001;
static_assert(kBetterShapeFactor > 1);
/// A corner of two triangles of a cap lies in the plane of the others if the sine of its elevation
/// is less.
inline constexpr double kFlatCapSines = 1e-3;
/// An edge of a cap that is turned out of the way of a cut may leave faces this much thinner: they
/// cost less than those that the crossing of the edge would leave.
inline constexpr double kWorseCapShapeFactor = 0.2;
/// A face is a needle if its doubled area is a smaller part of its squared longest side.
inline constexpr double kNeedleShape = 1e-4;

// ---- Sheets and cells.

/// A point that rounding cannot tell from a plane lies on it.
inline constexpr double kOnPlaneTerms = 2e-15;
/// A point that floats cannot tell from a plane is compared with it in double: 16 roundings.
inline constexpr double kInFloatTerms = 1e-6;
/// A point nearer to a line of its face is on it.
inline constexpr double kOnLineSizes = 1e-10;
/// A place that misses its face by less is in it.
inline constexpr double kInFaceBarycentric = 1e-6;
/// A crossing that is nearer to an edge of its face is on it: the face beyond crosses there too.
inline constexpr double kSamePlaceBarycentric = 1e-9;
/// Cells are searched across edges of which more than this is inside.
inline constexpr double kInCellEdges = 1e-9;
/// An edge of a rim may miss its plane by the sum of both: an end snaps where a face is too small.
inline constexpr double kOnSideEdges = 1e-2;
inline constexpr double kOnSideCoordinates = 1e-6;
static_assert(kSnapEdges < kOnSideEdges, "an edge that snapped is still on its plane");

// ---- Gaps.

/// Two segments that are nearer to opposite directions have no outer corner.
inline constexpr double kStraightBackRadians = 1e-6;
/// A gap that goes on from a rim begins this far behind it, so that nothing is left between them.
inline constexpr double kOverlapWidths = 0.1;
/// A rim that is turned farther from the way of the blade does not say where a gap begins.
inline constexpr double kRimAcrossCosine = 0.5;
/// Faces that look away from the blade belong to another layer if they lie deeper below the tear.
inline constexpr double kOtherLayerWidths = 2;

// ---- Caps and walls.

/// Smaller weights of inner points are left out, unless the largest one is not much larger. They
/// are means over the whole rim, most of them too small for a file whose weights have 8 bits.
inline constexpr double kLeastCapWeight = 0x1p-8;
inline constexpr double kLeastCapWeightByLargest = 0.1;
/// A linear map whose determinant is below this fraction of its cubed norm has no inverse.
inline constexpr double kNoInverseDeterminant = 1e-6;
/// A wall is smooth along its lip unless it turns by more than the angle of this cosine.
inline constexpr double kSmoothWallCosine = 0.5;
/// A rim turns back at a tip: two edges whose directions have a smaller product than this.
inline constexpr double kTurnsBackCosine = -0.97;
/// How far a wall leans below the opposite lip, as a fraction of its depth.
inline constexpr double kLeanDepths = 1.0;
/// Most of an edge by which the lower edge of its wall may be shorter.
inline constexpr double kMostShorterEdges = 0.6;
/// The sum of two unit directions across a rim that is too short to lean in its direction.
inline constexpr double kLeastUnder = 0.1;
/// Least depth of a wall as a fraction of the wanted one, however near the next layer is.
inline constexpr double kLeastRoom = 1e-3;
/// Where a search for the surface below a lip begins, as a fraction of its way.
inline constexpr double kBelowLipWays = 1e-4;
/// A face near blades is within this fraction of its size, and of that of the blades, of a box
/// around it in float.
inline constexpr double kNearBladeSizes = 1e-3;
/// A closed rim goes round the axis of a bore if its turn differs from a full one by less.
inline constexpr double kRingQuarterTurns = 0.1;

// ---- Rounding of posed points, and of the boxes around them.

/// Posed points in double.
inline constexpr double kPosedCoordinates = 1e-12;
/// Boxes are widened by this and kPosedCoordinates.
inline constexpr double kBoxSizes = 1e-9;
/// A bone's translation in double, in the frame of a query.
inline constexpr double kTranslationCoordinates = 1e-13;
static_assert(kTranslationCoordinates < kPosedCoordinates);
/// Posed points in float: each of a few products, and their sum.
inline constexpr float kFloatCoordinates = 1e-6f;
inline constexpr float kFloatSumCoordinates = 2e-6f;
static_assert(kFloatCoordinates < kFloatSumCoordinates);
/// The same for a sum of bones' images, for each of its terms.
inline constexpr float kFloatTerms = 1e-7f;
/// A component of a bone's matrix that cancelled, relative to the column's sum.
inline constexpr float kCancelledTerms = 1e-8f;
/// The rounding that is assumed where all coordinates are zero.
inline constexpr float kLeastRoundingMetres = 1e-30f;
/// Positions of new vertices against their source triangle: each is rounded to float once, and a
/// wall on a wall again.
inline constexpr float kNewVertexCoordinates = 0x1p-20f;
/// The sum of a vertex's weights differs from 1 by at most this for each of them.
inline constexpr double kWeightSumPerInfluence = 2e-7;
/// A refitted position and its weights, when they are rounded to float.
inline constexpr double kStoredFitLengths = 1.5e-7;

// ---- Range of float: neither products nor sums of what lies within overflow. Beyond it no bound
// is known.

inline constexpr float kLargestPosedMetres = 1e18f;
/// The rounding of a point 1e28 metres away is still finite in float.
inline constexpr double kFarthestPosedMetres = 1e28;
inline constexpr double kLargestMorphMetres = 1e30;
static_assert(kLargestPosedMetres < kFarthestPosedMetres &&
              kFarthestPosedMetres < kLargestMorphMetres);
/// Sides of boxes between these have a direction in float: squares neither vanish nor overflow.
inline constexpr float kShortestSideMetres = 1e-15f;
inline constexpr float kLongestSideMetres = 1e15f;
static_assert(kShortestSideMetres < kLongestSideMetres && kLongestSideMetres < kLargestPosedMetres);

}  // namespace sunder::tear
