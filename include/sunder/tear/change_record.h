#pragma once

#include <sunder/core/mesh.h>

#include <vector>

namespace sunder {

/// A triangle of the mesh whose corners now name other vertices.
struct RewrittenTriangle {
  std::uint32_t triangle = 0;  ///< In Mesh::triangles.
  Triangle before = {};
};

/// What one operation did to one mesh. Vertices and triangles are only ever appended: their numbers stay valid.
struct MeshChange {
  std::uint32_t mesh = 0;
  std::uint32_t first_vertex = 0, vertex_count = 0;      ///< Appended.
  std::uint32_t first_triangle = 0, triangle_count = 0;  ///< Appended.
  std::vector<RewrittenTriangle> rewritten;              ///< Ascending by triangle.
};

/// Two surface points that were one before the tear; left and right of the stroke's direction, seen from outside.
struct LipPair {
  std::uint32_t left = 0;
  std::uint32_t right = 0;
};

/// What one operation did, for whoever mirrors the model: engine buffers, particles, bounds.
struct ChangeRecord {
  std::uint32_t first_point = 0, point_count = 0;  ///< Surface points appended.
  std::vector<MeshChange> meshes;                  ///< Those that changed, ascending.
  std::vector<LipPair> lips;                       ///< In order along the tear. Tips are single points and not listed.
};

}  // namespace sunder
