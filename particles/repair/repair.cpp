#include "particles/repair/repair.h"

#include "particles/clusters/band.h"
#include "particles/clusters/gradients.h"
#include "particles/repair/changed_weights.h"
#include "particles/repair/cover.h"
#include "particles/repair/follow_weld.h"
#include "particles/repair/lip_band.h"
#include "particles/repair/lip_edges.h"
#include "particles/repair/lip_points.h"
#include "particles/repair/lip_sides.h"
#include "particles/repair/new_points.h"
#include "particles/repair/renew_cells.h"
#include "particles/repair/vertex_points.h"

namespace sunder::particles {
namespace {

/// Begins a change, unless the current stroke has one.
void begin_change(Structure& structure) {
  TearLog& tears = structure.tears;
  if (!tears.done.empty() && tears.done.back().operation == 0) return;
  tears.undone.clear();
  const std::shared_ptr<const PendingWork> pending = pending_work(structure);
  if (tears.waiting) resume_work(structure, pending, false);
  structure.points.drop_undone();
  Change& change = tears.done.emplace_back();
  change.points = structure.points.count();
  change.particles = static_cast<Index>(structure.particles.size());
  change.lips = static_cast<Index>(structure.lips.size());
  change.ends_before = structure.points.ends;
  for (const auto& points : structure.vertex_points.of_mesh)
    change.vertices.push_back(static_cast<Index>(points.size()));
  change.pending_before = pending;
  structure.gradients->begin_change(change);
  structure.scratch.logged_points.begin(change.points);
  structure.scratch.logged_particles.begin(change.particles);
}

/// The points on the lips of the edit's tear, so far.
std::vector<Index> all_lips(const StructureEdit& edit) {
  const PointTable& points = edit.structure().points;
  const auto is_on_lip = [&](Index point) { return points.lip_points[point].tear == edit.tear(); };
  std::vector<Index> lips;
  edit.change().changed_points.for_each([&](const Change::OfPoint& of) {
    if (is_on_lip(of.point)) lips.push_back(of.point);
  });
  for (Index point = edit.change().points; point < points.count(); ++point)
    if (is_on_lip(point)) lips.push_back(point);
  return lips;
}

}  // namespace

void follow_operation(const TornModel& model, Structure& structure,
                      std::span<const ChangeRecord> changes) {
  begin_change(structure);
  TearLog& tears = structure.tears;
  if (tears.band) tears.band->met_count = 0;  // the front may have met what is no longer there
  StructureEdit edit(model, structure, tears.done.back(),
                     static_cast<Index>(tears.done.size() - 1));
  const RewrittenFaces rewritten = find_rewritten_faces(model, structure, changes);
  append_points(edit);
  follow_changed_weights(edit, changes);
  std::vector<Index> lost = leave_lost_points(edit, changes);
  leave_welded_points(edit, changes, lost);
  renew_vertex_points(edit, changes, lost);
  const std::vector<Index> lips = put_points_on_lips(edit, changes);
  spread_to_new_points(edit, lips.empty() ? kNone : edit.tear());
  if (!lips.empty()) choose_sides(edit, lips);
  reach_across_welds(edit, changes);
  const bool is_final = !model.is_in_stroke();
  const std::vector<Index> of_band = is_final ? all_lips(edit) : lips;
  if (!of_band.empty()) {
    begin_band(edit, of_band, is_final);
  } else {
    cover_taken_up(edit);
    const bool is_band_outdated = tears.band && edit.taken_up_count() > 0;
    if (!lost.empty() || is_band_outdated) begin_hole(edit);
  }
  renew_lip_edges(edit, lips, lost);
  renew_welded_lip_edges(edit, changes);
  edit.finish(rewritten);
}

void settle_band(const TornModel& model, Structure& structure, Index points) {
  TearLog& tears = structure.tears;
  while (tears.band && points > 0) {
    StructureEdit edit(model, structure, tears.done.back(), tears.band->tear);
    points = widen_band(edit, points);
    edit.finish({});
  }
}

}  // namespace sunder::particles
