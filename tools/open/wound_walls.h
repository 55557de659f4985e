#pragma once

#include <sunder/core/character.h>

#include <span>
#include <vector>

#include "tools/picture/wound_flesh.h"

namespace sunder::tools {

/// The ground of wounds as parts of meshes: what is seen between lips that gape.
struct WoundWalls {
  /// A vertex with the attributes and weights of one of the lips, at another place.
  struct Vertex {
    std::uint32_t like = 0;     ///< Vertex of the torn mesh.
    Vec3f closed, open;         ///< Model space, in the pose of the opening.
    Vec3f normal;               ///< Likewise; of the open wound.
    Vec2f uv;                   ///< Along the wound in units of its width; 0 to 1 from lip to lip.
    std::uint32_t submesh = 0;  ///< Of the lip.
  };
  struct OfMesh {
    std::vector<Vertex> vertices;
    std::vector<Triangle> triangles;  ///< Of `vertices`, all of one submesh.
  };
  std::vector<OfMesh> meshes;

  [[nodiscard]] std::size_t triangle_count() const;
};

/// Walls for wounds that are open: they begin at the vertices of the lips and leave no crack, hold
/// as the lips in every pose, and are no deeper than the body is thick.
/// @param torn          of which `closed` and `open` are poses.
/// @param closed, open  as Opening's.
[[nodiscard]] WoundWalls make_wound_walls(const TornModel& torn, std::span<const Wound> wounds,
                                          const std::vector<DeformedMesh>& closed,
                                          const std::vector<DeformedMesh>& open);

}  // namespace sunder::tools
