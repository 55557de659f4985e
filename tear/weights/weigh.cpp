#include "tear/weights/weigh.h"

#include <sunder/weights/influences.h>

#include <algorithm>
#include <tuple>

#include "tear/surface/morph_displacement.h"
#include "weights/internal/bind_position.h"

namespace sunder::tear {
namespace {

using VertexRef = SurfaceEditor::VertexRef;

bool comes_before(const VertexRef& a, const VertexRef& b) {
  return std::tie(a.mesh, a.vertex) < std::tie(b.mesh, b.vertex);
}

}  // namespace

std::vector<VertexRef> weighable_points(const VertexRanges& ranges, const SurfaceEditor& editor) {
  std::vector<VertexRef> points;
  for (Index mesh = 0; mesh < ranges.size(); ++mesh)
    for (Index vertex = ranges[mesh][0]; vertex < ranges[mesh][1]; ++vertex)
      if (editor.is_weighable(mesh, vertex)) points.push_back({mesh, vertex});
  return points;
}

Weighing weigh(std::span<const VertexRef> points, const WeightOptions& options,
               std::span<const std::vector<Affine3d>> palettes,
               std::span<const float> morph_weights, const SurfaceEditor& editor,
               WeightReport& report) {
  Weighing weighing;
  weighing.points.reserve(points.size());
  AnimationPoint exact;
  for (const VertexRef& at : points) {
    const Mesh& mesh = editor.character().meshes[at.mesh];
    const std::span<const Influence> born = editor.born_influences(at.mesh, at.vertex);
    WeighedPoint point{at, options.policy, editor.born_position(at.mesh, at.vertex),
                       static_cast<Index>(weighing.influences.size()),
                       static_cast<Index>(born.size())};
    weighing.influences.insert(weighing.influences.end(), born.begin(), born.end());
    if (options.maximum_influences != 0 && born.size() > options.maximum_influences) {
      const auto of_point = std::span(weighing.influences).subspan(point.first_influence);
      if (const std::size_t kept = prune_influences(of_point, options.maximum_influences);
          kept > 0) {
        point.influence_count = static_cast<Index>(kept);
        ++report.pruned;
      }
      weighing.influences.resize(point.first_influence + point.influence_count);
    }
    if (options.policy == WeightPolicy::pose_exact) {
      editor.describe_exactly(at, morph_weights, exact);
      const auto influences =
          std::span<const Influence>(weighing.influences).subspan(point.first_influence);
      const std::vector<Affine3d>& palette = palettes[mesh.skin];
      const auto bind = solve_bind_position(influences, exact.posed(palette), palette);
      if (bind)
        point.position = (*bind - morph_displacement(mesh, at.vertex, morph_weights)).cast<float>();
      else
        ++report.ill_conditioned;
    }
    weighing.points.push_back(point);
  }
  report.points += static_cast<Index>(points.size());
  return weighing;
}

SurfaceEditor::WeightChange change_to(const Weighing& weighing, const VertexRanges& ranges,
                                      SurfaceEditor& editor) {
  SurfaceEditor::WeightChange change;
  if (weighing.points.empty()) return change;
  change.influences = weighing.influences;
  const auto& meshes = editor.character().meshes;
  for (Index mesh = 0; mesh < meshes.size(); ++mesh)
    for (Index vertex = ranges[mesh][0]; vertex < meshes[mesh].vertex_count(); ++vertex) {
      const VertexRef original = editor.original(mesh, vertex);
      const auto point = std::lower_bound(
          weighing.points.begin(), weighing.points.end(), original,
          [](const WeighedPoint& a, const VertexRef& b) { return comes_before(a.vertex, b); });
      if (point == weighing.points.end() || point->vertex != original) continue;
      const auto influences = std::span<const Influence>(weighing.influences)
                                  .subspan(point->first_influence, point->influence_count);
      const bool is_as_born = point->position == editor.born_position(mesh, vertex) &&
                              std::ranges::equal(influences, editor.born_influences(mesh, vertex));
      change.vertices.push_back({mesh, vertex, point->policy, point->position,
                                 point->first_influence, point->influence_count,
                                 is_as_born ? kNone : editor.keep_born(mesh, vertex)});
    }
  return change;
}

void weigh_new_points(const SurfaceEditor::Mark& begin, const WeightOptions& options,
                      std::span<const std::vector<Affine3d>> palettes,
                      std::span<const float> morph_weights, SurfaceEditor& editor,
                      WeightReport& report) {
  if (options == WeightOptions{} && !editor.has_exact()) return;
  VertexRanges ranges;
  const auto& meshes = editor.character().meshes;
  const std::vector<Index> counts = editor.vertex_counts_at(begin);
  for (Index mesh = 0; mesh < meshes.size(); ++mesh)
    ranges.push_back({counts[mesh], meshes[mesh].vertex_count()});
  for (Index mesh = 0; mesh < meshes.size(); ++mesh)
    editor.update_exact(mesh, ranges[mesh][0]);  // copies of older points
  if (options == WeightOptions{}) return;
  const Weighing weighing =
      weigh(weighable_points(ranges, editor), options, palettes, morph_weights, editor, report);
  SurfaceEditor::WeightChange change = change_to(weighing, ranges, editor);
  editor.exchange(change);
}

}  // namespace sunder::tear
