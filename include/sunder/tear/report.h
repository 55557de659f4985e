#pragma once

#include <sunder/core/math.h>

#include <cstdint>
#include <vector>

namespace sunder {

/// A connected component of the surface that an operation separated from the rest.
struct TornPiece {
  struct Triangles {
    std::uint32_t mesh = 0;
    std::vector<std::uint32_t> triangles;  ///< Ascending.
  };
  std::vector<Triangles> meshes;  ///< Ascending by mesh.
  std::uint32_t triangle_count = 0;
  /// Indices, in the skeleton and ascending, of the bones that move a vertex of the piece.
  std::vector<std::uint32_t> bones;
  double area_posed = 0.0;               ///< Square metres.
  Vec3d centroid_posed = Vec3d::Zero();  ///< Area-weighted centroid, model space.
};

/// Figures of the points to which an operation assigned weights: those that lie between vertices.
/// Vertices at one point count once.
struct WeightReport {
  std::uint32_t points = 0;
  /// `pose_exact`: points that kept their interpolated bind positions.
  std::uint32_t ill_conditioned = 0;
  /// `refit`: points that got weights with a smaller error over the poses.
  std::uint32_t refitted = 0;
  /// Points that lost influences to WeightOptions::maximum_influences.
  std::uint32_t pruned = 0;
  /// `refit`: no pose moves a point farther from its exact place than this, metres: with
  /// barycentric weights and as they were fitted. Joints are free, and only points with a
  /// certificate count; see docs/certificate.md.
  double certified_barycentric = 0, certified = 0;
  std::uint32_t uncertified = 0;  ///< `refit`: points without a certificate.
};

/// Figures of one operation. Fields that do not apply to the operation are zero.
struct TearReport {
  /// Connected runs of torn surface. 0 if the operation missed; then nothing changed.
  std::uint32_t runs = 0;
  std::uint32_t segments = 0;  ///< Segments of the stroke.
  /// Segments that met no surface within the blade's reach.
  std::uint32_t segments_missed = 0;
  std::uint32_t faces_crossed = 0;
  std::uint32_t points_added = 0;
  std::uint32_t vertices_added = 0;
  std::uint32_t triangles_added = 0;
  /// Retired triangles that existed before the operation.
  std::uint32_t triangles_retired = 0;
  /// Places where the surface could not be torn, because its faces are too small or degenerate.
  std::uint32_t blocked = 0;
  /// Length of the tear, or of all edges of a cut, on the posed surface, metres.
  double length_posed = 0.0;
  /// Posed area of the surface that lay in the gap or bore, square metres.
  double area_removed_posed = 0.0;
  WeightReport weights;
  /// Regions of the flat section that were closed, counted once per side.
  std::uint32_t caps = 0;
  /// Rims of a cut or bore that got no cap or wall, for example because they do not close.
  std::uint32_t open_sections = 0;
  /// The separated pieces. For a tear or bore: the connected components that were part of a larger
  /// one before, except the one with the most faces. For a cut: every component with an edge on the
  /// cut, if the cut separated any.
  std::vector<TornPiece> pieces;
};

}  // namespace sunder
