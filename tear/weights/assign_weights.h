#pragma once

#include <sunder/operation/weight_options.h>
#include <sunder/tear/report.h>

#include <span>
#include <vector>

#include "skinning/internal/character_pose.h"
#include "tear/surface/surface_editor.h"
#include "tear/surface/weight_change.h"

namespace sunder::tear {

/// A range of vertices per mesh: [first, end).
using VertexRanges = std::vector<std::array<Index, 2>>;

/// The weights and bind position assigned to a point.
struct PointWeights {
  VertexRef vertex;  ///< The first vertex of the point.
  WeightPolicy policy = WeightPolicy::barycentric;
  Vec3f position = Vec3f::Zero();
  Index first_influence = 0, influence_count = 0;  ///< In WeightAssignment::influences.
};

/// Weights and bind positions assigned to some points.
struct WeightAssignment {
  std::vector<PointWeights> points;  ///< Ascending by mesh and vertex.
  std::vector<Influence> influences;
};

/// The points created in some ranges whose attributes are interpolated between other vertices.
[[nodiscard]] std::vector<VertexRef> interpolated_points(const VertexRanges& ranges,
                                                         const SurfaceEditor& editor);

/// Computes the weights of points by a policy; `refit` starts as `barycentric`.
/// @param pose  used by `pose_exact` only.
[[nodiscard]] WeightAssignment compute_weights(std::span<const VertexRef> points,
                                               const WeightOptions& options,
                                               const CharacterPose& pose,
                                               const SurfaceEditor& editor, WeightReport& report);

/// The change that gives all vertices of each point the assigned weights, for exchange_weights().
/// @param ranges  the ranges in which the points were created.
[[nodiscard]] WeightChange make_weight_change(const WeightAssignment& assignment,
                                              const VertexRanges& ranges, SurfaceEditor& editor);

/// Assigns weights to the points created since `begin`. Does nothing if the options are those with
/// which points are created.
void assign_new_weights(const EditLog::Mark& begin, const WeightOptions& options,
                        const CharacterPose& pose, SurfaceEditor& editor, WeightReport& report);

}  // namespace sunder::tear
