#pragma once

#include <sunder/core/mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace sunder {

/// Where a vertex that an operation appended comes from, as a file tells it.
struct VertexOrigin {
  /// The values that are the mean of those of the parents.
  enum class Values : std::uint8_t {
    all,     ///< Every attribute.
    motion,  ///< Position, weights and the displacements of position by morph targets. The vertex
             ///< is on the rim of a wall or cap, and is shaded as a part of it.
    none,    ///< The vertex is inside a wall or cap, or on its rim at a point of another mesh.
  };

  Triangle parents = {};  ///< Vertices of the mesh that are older; the vertex itself for `none`.
  std::array<double, 3> parts = {1.0, 0, 0};  ///< Per parent; >= 0, sum 1.
  Values values = Values::all;
  /// The number of the WeightPolicy: with pose_exact and refit the position, with refit the weights
  /// too, are fitted and not the mean.
  std::uint8_t policy = 0;
  /// The policy has dropped influences.
  bool is_limited = false;

  bool operator==(const VertexOrigin&) const = default;
};

/// A triangle of the source of which operations removed a part.
struct ReducedTriangle {
  std::uint32_t triangle = 0;  ///< Index in the source mesh.
  double remaining = 0.0;      ///< Share of the area in bind space, [0, 1).

  bool operator==(const ReducedTriangle&) const = default;
};

/// The origins of what a torn mesh has in addition to its source, as vertex_origins() of
/// <sunder/tear/torn_weights.h> finds them and SaveOptions::origins writes them.
struct MeshOrigins {
  std::uint32_t first_vertex = 0;        ///< The vertices before are those of the source.
  std::vector<VertexOrigin> vertices;    ///< From first_vertex on.
  std::vector<ReducedTriangle> reduced;  ///< Ascending.

  bool operator==(const MeshOrigins&) const = default;
};

}  // namespace sunder
