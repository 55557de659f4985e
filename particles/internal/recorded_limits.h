#pragma once

#include <cstdint>

namespace sunder::particles {

// Limits of the numbers in recorded states, which may come from strangers: what is beyond them is
// refused. docs/particles.md lists them.

/// Places, displacements and velocities: metres, and metres per second.
inline constexpr double kMostRecordedLength = 1e9;
/// Forces and accelerations: newtons, and metres per second squared.
inline constexpr double kMostRecordedForce = 1e12;
/// Seconds: 30,000 years.
inline constexpr double kMostRecordedSeconds = 1e12;
/// Revisions and serial numbers, so that counting goes on.
inline constexpr std::uint64_t kMostRecordedNumber = std::uint64_t{1} << 62u;
/// Points lie within so many diagonals of the decomposition's surface, from its middle.
inline constexpr double kRecordedPlaceDiagonals = 2;
/// By what factor the largest number of a member may have been larger before other weights.
inline constexpr double kRecordedSumFactor = 16;
/// Error of sums, relative to what one member or face can add.
inline constexpr double kRecordedSumError = 1e-3;
/// Least range of a particle, relative to that of the decomposition.
inline constexpr double kLeastRecordedRange = 1e-9;
inline constexpr double kMostRecordedCoupling = 1e15;
/// How far the columns of a rotation may be from orthonormal ones.
inline constexpr double kRecordedTurnError = 1e-3;

}  // namespace sunder::particles
