#include "particles/clusters/structure.h"

#include <algorithm>

#include "particles/clusters/band.h"
#include "particles/clusters/gradients.h"

namespace sunder::particles {

Structure::Structure() : gradients(std::make_unique<Gradients>()) {}
Structure::~Structure() = default;

std::unique_ptr<Structure> Structure::copy() const {
  auto made = std::make_unique<Structure>();
  made->report = report;
  made->revision = revision;
  made->next_serial = next_serial;
  made->character.edge_length = character.edge_length;
  made->character = character;
  made->vertex_points = vertex_points;
  // The columns are copied into room for some more, so that the next tears need no other copy.
  made->points.make_room(points.count() + 1);
  PointColumns::for_each_column(
      [](auto& column, const auto& of) { column.insert(column.end(), of.begin(), of.end()); },
      made->points, points);
  made->points.memberships = points.memberships;
  made->points.older_lips = points.older_lips;
  made->authored = authored;
  made->particles = particles;
  made->members = members;
  made->lips = lips;
  made->tears.threads = tears.threads;
  if (const std::size_t known = gradients->known().size(); known > 0)
    made->gradients->make_room(known + 1);
  *made->gradients = *gradients;
  made->prepare_for_tears(tears.triangle_count);
  return made;
}

std::unique_ptr<Structure> Structure::fork() const {
  std::unique_ptr<Structure> made = copy();
  made->points.ends = points.ends;
  made->points.drop_undone();
  made->journal = journal;
  made->dirty.clear();
  made->tears.done.resize(tears.done.size());
  for (Change& change : made->tears.done) change.operation = Change::kUnnamed;
  made->tears.is_broken = tears.is_broken;
  return made;
}

void Structure::make_room(std::size_t point_count) {
  points.make_room(point_count);
  scratch.make_room(point_count);
}

void resume_log(Structure& structure) {
  if (structure.tears.done.empty()) return;
  const Change& last = structure.tears.done.back();
  structure.scratch.logged_points.begin(last.points);
  structure.scratch.logged_particles.begin(structure.particles.size());
  last.changed_points.for_each(
      [&](const Change::OfPoint& of) { (void)structure.scratch.logged_points.mark(of.point); });
  for (const auto& [particle, before] : last.changed_particles)
    (void)structure.scratch.logged_particles.mark(particle);
}

void Structure::finish(Index triangles) {
  tears.triangle_count = triangles;
  points.lip_points.resize(points.count());
  points.ends = {points.memberships.size(), points.older_lips.size()};
}

void Structure::prepare_for_tears(Index triangles) {
  finish(triangles);
  make_room(points.count() + 1);
  for (std::vector<Index>& of_mesh : vertex_points.of_mesh)
    reserve_eighth(of_mesh, of_mesh.size() + 1);
}

bool Structure::follow_threads(const TornModel& model) {
  const std::span<const SutureThread> now = threads_of(model);
  if (std::equal(now.begin(), now.end(), tears.threads.begin(), tears.threads.end())) return false;
  tears.threads.assign(now.begin(), now.end());
  return true;
}

void Structure::note_dirty_points() {
  journal.points.add(dirty);
  const std::size_t most = points.count() / 2 + 4096;
  journal.points.trim(most);
  journal.vertices.trim(most);
}

}  // namespace sunder::particles
