#pragma once

#include <sunder/tear/torn_model.h>

#include <array>
#include <vector>

namespace sunder {

/// A vertex as the mean of three others of its mesh, once those are posed. Three 32-bit numbers for the parents, three floats for
/// their parts: 28 bytes, as a shader reads them.
struct ParentBlend {
  std::uint32_t vertex = 0;
  std::array<std::uint32_t, 3> parents = {};
  std::array<float, 3> parts = {};  ///< >= 0, sum 1; a parent without part is a repeated one.
};

/// The `exact` vertices of a mesh for an engine that skins on the GPU: skin all vertices as ever, then let one small pass write
/// these from their posed parents; positions and, to be made unit length, normals and tangents. Parents are vertices of the source,
/// however many operations lie between; only those of a wall or cap may be exact themselves, and come in an earlier level: one pass
/// a level. docs/weights.md has the shader.
struct ParentBlends {
  std::vector<ParentBlend> blends;         ///< Level after level, in each by ascending vertex.
  std::vector<std::uint32_t> level_begin;  ///< Where each level begins in `blends`, and the end.
};

/// @param mesh  unchecked. A vertex on the rim of a cap that closes several meshes, at a point of another mesh, is its own parent.
///              Vertices that share a point have the same parts of parents that coincide, bit for bit.
/// O(vertices appended), allocates.
[[nodiscard]] SUNDER_API ParentBlends parent_blends(const TornModel& model, std::uint32_t mesh);

}  // namespace sunder
