#pragma once

#include <sunder/tear/torn_model.h>

#include <array>
#include <span>
#include <vector>

namespace sunder {

/// A vertex as the mean of three others of its mesh, once those are posed. Three 32-bit numbers for
/// the parents, three floats for their parts: 28 bytes, as a shader reads them.
struct ParentBlend {
  std::uint32_t vertex = 0;
  std::array<std::uint32_t, 3> parents = {};
  std::array<float, 3> parts = {};  ///< >= 0, sum 1; a parent without part is a repeated one.
};

/// The `exact` vertices of a mesh for an engine that skins on the GPU: skin all vertices as ever,
/// then let one small pass write these from their posed parents; positions and, to be made unit
/// length, normals and tangents. Parents are vertices of the source, however many operations lie
/// between; only those of a wall or cap may be exact themselves, and come in an earlier level: one
/// pass a level. docs/weights.md has the shader.
struct ParentBlends {
  std::vector<ParentBlend> blends;         ///< Level after level, in each by ascending vertex.
  std::vector<std::uint32_t> level_begin;  ///< Where each level begins in `blends`, and the end.
};

/// @param mesh  unchecked. A vertex on the rim of a cap that closes several meshes, at a point of
/// another mesh, is its own parent.
///              Vertices that share a point have the same parts of parents that coincide, bit for
///              bit.
/// O(vertices appended), allocates.
[[nodiscard]] SUNDER_API ParentBlends parent_blends(const TornModel& model, std::uint32_t mesh);

/// How far the points that operations made stand, in some poses, from where they lie between the
/// vertices that they were born between: where the surface was before it was torn.
struct WeightErrors {
  struct Statistics {
    double rms = 0, percentile95 = 0, maximum = 0;
  };
  struct OfPoint {
    std::uint32_t mesh = 0, vertex = 0;  ///< The first of the vertices that share the point.
    double rms = 0, maximum = 0;         ///< Over the poses, metres.
    double edge = 0;  ///< Mean edge of the triangle that it was born in, in the rest pose, metres.
  };

  std::uint32_t poses = 0;
  Statistics metres;       ///< Over points and poses.
  Statistics of_diagonal;  ///< In parts of the diagonal of the source in the rest pose.
  Statistics of_edge;      ///< In parts of OfPoint::edge.
  std::vector<OfPoint> points;
};

/// @param first_operation  of those done and not taken back.
/// @param operation_count  kNone: all from there on. What is in the model now is measured, whatever
/// weighed it.
/// @param poses            one matrix a bone, all finite; none: all figures are zero.
/// @return not_found where there are no such operations; size_mismatch or non_finite_value with the
/// pose. A model that lost an
///         operation is another one: measure before undoing. O(points x poses), and the first time
///         O(vertices of the source); allocates.
[[nodiscard]] SUNDER_API Result<WeightErrors> measure_weight_errors(
    const TornModel& model, std::uint32_t first_operation, std::uint32_t operation_count,
    std::span<const ModelPose> poses);

}  // namespace sunder
