#pragma once

#include <sunder/core/character.h>
#include <sunder/validation/finding.h>
#include <sunder/weights/influences.h>

#include <span>
#include <vector>

#include "pipeline/validation/match/bind_surface.h"

namespace sunder::validation {

/// The points of a surface as a graph. Points are those of BindSurface::weld.
struct PointGraph {
  struct Edge {
    Index a = 0, b = 0;  ///< a < b.
    std::uint32_t faces = 0;
  };

  std::vector<Edge> edges;         ///< Ascending.
  std::vector<Index> first = {0};  ///< Per point and the end, in `neighbours`.
  std::vector<Index> neighbours;
  std::vector<float> lengths;          ///< Metres, as `neighbours`.
  std::vector<Index> vertex_of_point;  ///< The first one.
  std::vector<Index> shell_of_point;   ///< Connected part of the surface.
  Index shell_count = 0;

  [[nodiscard]] Index point_count() const { return static_cast<Index>(first.size() - 1); }
  [[nodiscard]] std::span<const Index> around(Index point) const {
    return {neighbours.data() + first[point], first[point + 1] - first[point]};
  }
  [[nodiscard]] std::span<const float> lengths_around(Index point) const {
    return {lengths.data() + first[point], first[point + 1] - first[point]};
  }
  /// Mean length of the edges at a point; 0 without edges.
  [[nodiscard]] double mean_length(Index point) const;
  /// Whether two points are joined by an edge. O(edges at `a`).
  [[nodiscard]] bool has_edge(Index a, Index b) const;
};

/// O(triangles log triangles), allocates.
[[nodiscard]] PointGraph make_point_graph(const BindSurface& surface);

/// A model with all that the checks derive from it once.
struct Skinned {
  const Character& character;
  std::span<const StoredInfluences> stored;  ///< One per mesh, or none.
  BindSurface surface;
  PointGraph graph;
  double rest_diagonal = 0.0;  ///< Of the box in the rest pose, metres.
  /// Lengths of the surface are of bind space, whose unit is that of the file's vertices. In the
  /// rest pose they are this many times as long: the median over the bones of the skins of the
  /// change of length (cube root of the volume) from bind to rest. 0.01 where an armature brings
  /// centimetres to metres, 1 in most models.
  double metres_per_bind_unit = 1.0;

  /// The surface in the character's own bind pose.
  /// @param of  outlives this, as do the stored influences.
  Skinned(const Character& of, std::span<const StoredInfluences> stored_influences);
  /// The surface in a pose.
  Skinned(const Character& of, std::span<const StoredInfluences> stored_influences,
          const ModelPose& pose);

  [[nodiscard]] std::span<const Influence> influences(Index mesh, Index vertex) const {
    return character.meshes[mesh].weights.of(vertex);
  }
  [[nodiscard]] Index bone(Index mesh, Index slot) const {
    return character.skins[character.meshes[mesh].skin].bones[slot];
  }
  /// The place of a vertex, numbered in its mesh.
  [[nodiscard]] FindingPlace place(Index mesh, Index vertex, Index bone, double value) const {
    return {mesh, vertex, bone, surface.positions[surface.first_vertex[mesh] + vertex], value};
  }
  /// The place of a vertex, numbered in the surface.
  [[nodiscard]] FindingPlace place(Index vertex, Index bone, double value) const {
    const Index mesh = surface.mesh_of_vertex(vertex);
    return {mesh, vertex - surface.first_vertex[mesh], bone, surface.positions[vertex], value};
  }
};

}  // namespace sunder::validation
