#include "tear/weights/assign_weights.h"

#include <sunder/weights/influences.h>

#include <algorithm>
#include <tuple>

#include "tear/surface/morph_displacement.h"
#include "tear/surface/weight_change.h"
#include "weights/internal/bind_position.h"

namespace sunder::tear {
namespace {

bool comes_before(const VertexRef& a, const VertexRef& b) {
  return std::tie(a.mesh, a.vertex) < std::tie(b.mesh, b.vertex);
}

}  // namespace

std::vector<VertexRef> interpolated_points(const VertexRanges& ranges,
                                           const SurfaceEditor& editor) {
  std::vector<VertexRef> points;
  for (Index mesh = 0; mesh < ranges.size(); ++mesh)
    for (Index vertex = ranges[mesh][0]; vertex < ranges[mesh][1]; ++vertex)
      if (editor.births.is_weighable(mesh, vertex)) points.push_back({mesh, vertex});
  return points;
}

namespace {

/// Appends the barycentric influences of a point, pruned to the requested number.
PointWeights append_barycentric(const VertexRef& at, const WeightOptions& options,
                                const SurfaceEditor& editor, WeightAssignment& assignment,
                                WeightReport& report) {
  const std::span<const Influence> born = editor.births.influences(at.mesh, at.vertex);
  std::vector<Influence>& influences = assignment.influences;
  PointWeights point{at, options.policy, editor.births.position(at.mesh, at.vertex),
                     static_cast<Index>(influences.size()), static_cast<Index>(born.size())};
  influences.insert(influences.end(), born.begin(), born.end());
  if (options.maximum_influences == 0 || born.size() <= options.maximum_influences) return point;
  const auto of_point = std::span(influences).subspan(point.first_influence);
  if (const std::size_t kept = prune_influences(of_point, options.maximum_influences); kept > 0) {
    point.influence_count = static_cast<Index>(kept);
    ++report.pruned;
  }
  influences.resize(point.first_influence + point.influence_count);
  return point;
}

}  // namespace

WeightAssignment compute_weights(std::span<const VertexRef> points, const WeightOptions& options,
                                 const CharacterPose& pose, const SurfaceEditor& editor,
                                 WeightReport& report) {
  WeightAssignment assignment;
  assignment.points.reserve(points.size());
  AnimationPoint exact;
  for (const VertexRef& at : points) {
    PointWeights point = append_barycentric(at, options, editor, assignment, report);
    if (options.policy == WeightPolicy::pose_exact) {
      const Mesh& mesh = editor.character().meshes[at.mesh];
      editor.births.describe_exactly(at, pose.morph_weights(), exact);
      const auto influences =
          std::span<const Influence>(assignment.influences).subspan(point.first_influence);
      const std::vector<Affine3d>& palette = pose.palette(mesh.skin);
      const auto bind = solve_bind_position(influences, exact.posed(palette), palette);
      if (bind)
        point.position =
            (*bind - morph_displacement(mesh, at.vertex, pose.morph_weights())).cast<float>();
      else
        ++report.ill_conditioned;
    }
    assignment.points.push_back(point);
  }
  report.points += static_cast<Index>(points.size());
  return assignment;
}

WeightChange make_weight_change(const WeightAssignment& assignment, const VertexRanges& ranges,
                                SurfaceEditor& editor) {
  WeightChange change;
  if (assignment.points.empty()) return change;
  change.influences = assignment.influences;
  const auto& meshes = editor.character().meshes;
  for (Index mesh = 0; mesh < meshes.size(); ++mesh)
    for (Index vertex = ranges[mesh][0]; vertex < meshes[mesh].vertex_count(); ++vertex) {
      const VertexRef original = editor.births.original(mesh, vertex);
      const auto point = std::lower_bound(
          assignment.points.begin(), assignment.points.end(), original,
          [](const PointWeights& a, const VertexRef& b) { return comes_before(a.vertex, b); });
      if (point == assignment.points.end() || point->vertex != original) continue;
      const auto influences = std::span<const Influence>(assignment.influences)
                                  .subspan(point->first_influence, point->influence_count);
      const bool is_as_born =
          point->position == editor.births.position(mesh, vertex) &&
          std::ranges::equal(influences, editor.births.influences(mesh, vertex));
      change.vertices.push_back({mesh, vertex, point->policy, point->position,
                                 point->first_influence, point->influence_count,
                                 is_as_born ? kNone : editor.births.keep(mesh, vertex)});
    }
  return change;
}

void assign_new_weights(const EditLog::Mark& begin, const WeightOptions& options,
                        const CharacterPose& pose, SurfaceEditor& editor, WeightReport& report) {
  if (options == WeightOptions{} && editor.exact.is_empty()) return;
  VertexRanges ranges;
  const auto& meshes = editor.character().meshes;
  const std::vector<Index> counts = editor.log.vertex_counts_at(begin);
  for (Index mesh = 0; mesh < meshes.size(); ++mesh)
    ranges.push_back({counts[mesh], meshes[mesh].vertex_count()});
  for (Index mesh = 0; mesh < meshes.size(); ++mesh)
    editor.exact.update_from(mesh, ranges[mesh][0]);  // of copies of older points
  if (options == WeightOptions{}) return;
  const WeightAssignment assignment =
      compute_weights(interpolated_points(ranges, editor), options, pose, editor, report);
  WeightChange change = make_weight_change(assignment, ranges, editor);
  exchange_weights(change, editor);
}

}  // namespace sunder::tear
