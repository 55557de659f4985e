#include <sunder/binding/binding.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "pipeline/binding/attach.h"
#include "pipeline/binding/bone_segments.h"
#include "pipeline/binding/heat.h"
#include "pipeline/binding/internal/option_ranges.h"
#include "pipeline/binding/joined.h"
#include "pipeline/binding/limit_weights.h"
#include "pipeline/binding/welded_surface.h"

namespace sunder {
namespace {

using binding::BoneWeight;
using binding::WeightRow;

/// The weights of each vertex, from those of the points.
std::vector<std::vector<WeightRow>> rows_of_vertices(const binding::WeldedSurface& surface,
                                                     const std::vector<WeightRow>& rows) {
  std::vector<std::vector<WeightRow>> of_meshes;
  for (const std::vector<Index>& points : surface.point_of_vertex) {
    auto& of_mesh = of_meshes.emplace_back();
    for (const Index point : points) of_mesh.push_back(rows[point]);
  }
  return of_meshes;
}

void list_bones_without_weight(const Skeleton& skeleton, std::vector<bool> is_missing,
                               const std::vector<WeightRow>& rows, HeatBinding& report) {
  for (const WeightRow& row : rows)
    for (const BoneWeight& entry : row) is_missing[entry.bone] = false;
  for (Index bone = 0; bone < is_missing.size(); ++bone)
    if (is_missing[bone]) report.bones_without_weight.push_back(skeleton.bones[bone].name);
}

Result<HeatBinding> heat_up(const Character& model, const Character& rig,
                            const HeatOptions& options) {
  if (const Status status = binding::kHeat.check(options.heat); !status) return status;
  const Result<binding::Joined> joined = binding::join(model, rig, options.place);
  if (!joined) return joined.error();
  const Result<std::vector<bool>> chosen = binding::choose_bones(rig, options.bones);
  if (!chosen) return chosen.error();
  const binding::WeldedSurface surface = binding::weld(*joined);
  const auto segments = binding::bone_segments(*joined, *chosen);
  Result<binding::HeatWeights> weights = binding::heat_weights(surface, segments, options.heat);
  if (!weights) return weights.error();

  HeatBinding report;
  for (WeightRow& row : weights->rows)
    report.largest_dropped_weight = std::max(
        report.largest_dropped_weight, binding::limit_weights(options.maximum_influences, row));
  list_bones_without_weight(rig.skeleton, *chosen, weights->rows, report);
  Result<Binding> attached =
      binding::attach(*joined, rows_of_vertices(surface, weights->rows), true);
  if (!attached) return attached.error();
  static_cast<Binding&>(report) = std::move(*attached);
  report.points = surface.point_count();
  report.heated_points = weights->heated_points;
  report.components = surface.part_count;
  report.components_without_sight = weights->parts_without_sight;
  report.lone_points = weights->lone_points;
  report.edges = weights->edges;
  report.clamped_edges = weights->clamped_edges;
  return report;
}

}  // namespace

Result<HeatBinding> bind_by_heat(const Character& model, const Character& rig,
                                 const HeatOptions& options) {
  return or_out_of_memory([&] { return heat_up(model, rig, options); });
}

}  // namespace sunder
