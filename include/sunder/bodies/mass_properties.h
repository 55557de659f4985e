#pragma once

#include <sunder/core/mesh.h>
#include <sunder/core/status.h>

#include <cstdint>
#include <span>

namespace sunder {

/// The body of which a surface is the boundary.
enum class SolidRule : std::uint8_t {
  closed,  ///< The volume that the closed surface encloses.
  /// The same of an open surface whose holes were closed: the edges that miss a neighbour and hang
  /// together are joined by triangles to the mean of their places, weighted by length. For a flat
  /// hole that is exact.
  fans,
  shell,  ///< The surface itself, of some thickness.
};

struct MassOptions {
  double density = 1000.0;  ///< kg / cubic metre; > 0.
  /// Bodies of open surfaces: `fans` or `shell`. A surface that encloses no volume is a shell in
  /// any case.
  SolidRule open_surfaces = SolidRule::fans;
  /// Thickness of shells, metres, >= 0. 0: 1 % of the square root of the area.
  double shell_thickness = 0.0;
};

/// Mass and inertia of a body with the same density everywhere.
struct MassProperties {
  SolidRule rule = SolidRule::closed;
  std::uint32_t holes = 0;  ///< Connected groups of edges that miss a neighbour.
  double area = 0.0;        ///< Of the surface without fans, square metres.
  double volume = 0.0;      ///< Cubic metres; of a shell, area times thickness.
  double mass = 0.0;        ///< Kilograms.
  Vec3d centre = Vec3d::Zero();
  /// Tensor about the centre, along the axes of the positions, kg m^2.
  Mat3d inertia = Mat3d::Zero();
};

/// Integrates over the body inside a surface by the divergence theorem, exactly up to rounding.
/// Vertices at the same position count as one, so seams are no holes, and lips that coincide close
/// each other.
/// @param positions  finite. @param triangles  counter-clockwise from outside; of a surface that is
///         inside out the enclosed volume counts all the same. Retired ones are skipped.
/// @return empty_input without a triangle; index_out_of_range with the triangle; non_finite_value
///         with the vertex; invalid_argument for the options; limit_exceeded (out of memory).
/// O(T log T), allocates. Source: Eberly, Polyhedral Mass Properties (Revisited), 2002
/// [eberly2002mass].
[[nodiscard]] SUNDER_API Result<MassProperties> compute_mass(std::span<const Vec3d> positions,
                                                             std::span<const Triangle> triangles,
                                                             const MassOptions& options = {});

/// @return the first fault of the options.
[[nodiscard]] SUNDER_API Status validate(const MassOptions& options);

/// The axes in which a tensor of inertia is diagonal.
struct PrincipalAxes {
  Vec3d moments = Vec3d::Zero();   ///< Ascending.
  Mat3d axes = Mat3d::Identity();  ///< Columns, one per moment; a rotation.
};

/// @param inertia  symmetric, finite. By Jacobi's rotations, so the same bits on every machine.
[[nodiscard]] SUNDER_API PrincipalAxes principal_axes(const Mat3d& inertia);

}  // namespace sunder
