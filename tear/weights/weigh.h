#pragma once

#include <sunder/operation/weight_options.h>
#include <sunder/tear/report.h>

#include <span>
#include <vector>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Vertices of each mesh, one range a mesh: [first, end).
using VertexRanges = std::vector<std::array<Index, 2>>;

/// A point that is to be weighed, by the first of its vertices.
struct WeighedPoint {
  SurfaceEditor::VertexRef vertex;
  WeightPolicy policy = WeightPolicy::barycentric;
  Vec3f position = Vec3f::Zero();
  Index first_influence = 0, influence_count = 0;
};

/// Points and what they are to have.
struct Weighing {
  std::vector<WeighedPoint> points;  ///< Ascending by mesh and vertex.
  std::vector<Influence> influences;
};

/// The points that were made in some ranges and lie between vertices.
[[nodiscard]] std::vector<SurfaceEditor::VertexRef> weighable_points(const VertexRanges& ranges,
                                                                     const SurfaceEditor& editor);

/// What a policy makes of points; `refit` begins as `barycentric`.
/// @param palettes  of each skin, in the pose that `pose_exact` meets.
[[nodiscard]] Weighing weigh(std::span<const SurfaceEditor::VertexRef> points,
                             const WeightOptions& options,
                             std::span<const std::vector<Affine3d>> palettes,
                             std::span<const float> morph_weights, const SurfaceEditor& editor,
                             WeightReport& report);

/// What gives points what was weighed for them, and the same to all vertices that share them: to be
/// exchanged.
/// @param ranges  where those begin; the first of each mesh.
[[nodiscard]] SurfaceEditor::WeightChange change_to(const Weighing& weighing,
                                                    const VertexRanges& ranges,
                                                    SurfaceEditor& editor);

/// Weighs the points that were made since `begin`; nothing is done where the policy is that of
/// births.
void weigh_new_points(const SurfaceEditor::Mark& begin, const WeightOptions& options,
                      std::span<const std::vector<Affine3d>> palettes,
                      std::span<const float> morph_weights, SurfaceEditor& editor,
                      WeightReport& report);

}  // namespace sunder::tear
