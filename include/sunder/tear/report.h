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
  std::vector<std::uint32_t>
      bones;                ///< Of the skeleton, ascending: those that move a vertex of the piece.
  double area_posed = 0.0;  ///< Square metres.
  Vec3d centroid_posed = Vec3d::Zero();  ///< Of the surface, by area; model space.
};

/// Figures of the points that an operation weighed: those that lie between vertices. Vertices at
/// one point count once.
struct WeightReport {
  std::uint32_t points = 0;
  std::uint32_t ill_conditioned = 0;  ///< `pose_exact`: kept their interpolated bind positions.
  std::uint32_t refitted = 0;         ///< `refit`: got weights that are better over the poses.
  std::uint32_t pruned = 0;           ///< Lost influences to WeightOptions::maximum_influences.
};

/// Figures of one operation. Fields that do not apply to the operation are zero.
struct TearReport {
  std::uint32_t runs =
      0;  ///< Connected runs of torn surface. 0: the operation missed and nothing changed.
  std::uint32_t segments = 0;         ///< Of the stroke.
  std::uint32_t segments_missed = 0;  ///< Met no surface within the blade's reach.
  std::uint32_t faces_crossed = 0;
  std::uint32_t points_added = 0;
  std::uint32_t vertices_added = 0;
  std::uint32_t triangles_added = 0;
  std::uint32_t triangles_retired = 0;  ///< Of those that were there before.
  std::uint32_t blocked = 0;  ///< Places where the surface could not be torn, because its faces are
                              ///< too small or degenerate.
  double length_posed =
      0.0;  ///< Of the tear on the posed surface, or of all edges of a cut, metres.
  double area_removed_posed = 0.0;  ///< Of the surface that lay in the gap or bore, square metres.
  WeightReport weights;
  std::uint32_t caps = 0;           ///< Faces of flat section closed, counted once for each side.
  std::uint32_t open_sections = 0;  ///< Runs of cut edges that do not close, and so got no cap.
  /// What came free. Of a tear or bore: what hung together with more before, all but the part with
  /// the most faces. Of a cut: every piece with an edge on it, if it separated any.
  std::vector<TornPiece> pieces;
};

}  // namespace sunder
