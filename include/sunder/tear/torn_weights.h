#pragma once

#include <sunder/core/vertex_origins.h>
#include <sunder/tear/torn_model.h>

#include <array>
#include <span>
#include <vector>

namespace sunder {

/// A vertex as the weighted mean of three posed vertices of its mesh. 28 bytes, in the layout of a
/// shader buffer.
struct ParentBlend {
  std::uint32_t vertex = 0;
  std::array<std::uint32_t, 3> parents = {};
  std::array<float, 3> parts = {};  ///< >= 0, sum 1. A parent with part 0 repeats another one.
};

/// The vertices of policy `exact` of a mesh, for an engine that skins on the GPU: it skins all
/// vertices, then a small pass computes these from their posed parents (positions, and normals and
/// tangents, to be normalised). Parents are vertices of the source, however many operations lie
/// between. Only the parents of a wall or cap may be `exact` themselves; they come in an earlier
/// level, and each level is one pass. docs/weights.md has the shader.
struct ParentBlends {
  std::vector<ParentBlend> blends;         ///< Level by level, in each by ascending vertex.
  std::vector<std::uint32_t> level_begin;  ///< First entry of each level in `blends`, and the end.
};

/// @param mesh  unchecked.
/// @return the blends of all `exact` vertices. A vertex on the rim of a cap over several meshes, at
/// a point of another mesh, is its own parent. Vertices that share a point have the same parts of
/// coincident parents, bit for bit. limit_exceeded: out of memory.
/// O(vertices appended), allocates. Reentrant while the model is not changed.
[[nodiscard]] SUNDER_API Result<ParentBlends> parent_blends(const TornModel& model,
                                                            std::uint32_t mesh);

/// The origins of all vertices that operations appended, and of the source triangles of which they
/// removed a part, for files: one entry per mesh. Indices are those of model.source(), which
/// compact() changes.
/// @return limit_exceeded: out of memory. O(vertices appended + triangles), allocates. Reentrant
/// while the model is not changed.
[[nodiscard]] SUNDER_API Result<std::vector<MeshOrigins>> vertex_origins(const TornModel& model);

/// The distances, over some poses, between torn points and the places on the untorn surface where
/// they were created.
struct WeightErrors {
  struct Statistics {
    double rms = 0, percentile95 = 0, maximum = 0;
  };
  /// The error of one point.
  struct OfPoint {
    std::uint32_t mesh = 0, vertex = 0;  ///< The first vertex of the point.
    double rms = 0, maximum = 0;         ///< Over the poses, metres.
    double edge = 0;  ///< Mean edge of the source triangle of the point in the rest pose, metres.
  };

  std::uint32_t poses = 0;
  Statistics metres;       ///< Over all points and poses.
  Statistics of_diagonal;  ///< Relative to the diagonal of the source in the rest pose.
  Statistics of_edge;      ///< Relative to OfPoint::edge.
  std::vector<OfPoint> points;
};

/// Measures the errors of the current weights, whatever assigned them.
/// @param first_operation  index among the operations that are done and not undone.
/// @param operation_count  kNone: all operations from there on.
/// @param poses            all finite; without poses, all figures are zero.
/// @return not_found if there are no such operations; size_mismatch or non_finite_value with the
/// pose. O(points x poses + vertices of the source); allocates. Reentrant while the model is not
/// changed.
[[nodiscard]] SUNDER_API Result<WeightErrors> measure_weight_errors(
    const TornModel& model, std::uint32_t first_operation, std::uint32_t operation_count,
    std::span<const ModelPose> poses);

}  // namespace sunder
