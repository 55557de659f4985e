#include "particles/clusters/change.h"

#include <algorithm>
#include <iterator>

#include "core/internal/prefetch.h"
#include "particles/clusters/structure.h"

namespace sunder::particles {
namespace {

/// Moves the entries of an array from `count` on into `tail`, or appends those of `tail`.
/// @param is_there  whether the array loses them.
template <class T>
void move_tail(std::vector<T>& values, std::size_t count, bool is_there, std::vector<T>& tail) {
  if (is_there) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(count);
    tail.assign(std::make_move_iterator(first), std::make_move_iterator(values.end()));
    values.erase(first, values.end());
  } else {
    values.insert(values.end(), std::make_move_iterator(tail.begin()),
                  std::make_move_iterator(tail.end()));
    tail.clear();
  }
}

/// Entries may be listed several times: undo goes through them backwards, redo forwards.
template <class T, class Exchange>
void exchange_in_turn(std::vector<T>& changes, bool is_done, Exchange exchange_one) {
  if (is_done)
    std::for_each(changes.rbegin(), changes.rend(), exchange_one);
  else
    std::for_each(changes.begin(), changes.end(), exchange_one);
}

/// Prefetches what an entry of a change exchanges.
void expect(const PointTable& points, Index point) {
  prefetch(&points.slabs[point]);
  prefetch(&points.influences[point]);
  prefetch(&points.owners[point]);
  prefetch(&points.lip_points[point]);
}

void exchange_changed(Structure& structure, Change& change, bool is_done) {
  PointTable& points = structure.points;
  const std::size_t count = change.changed_points.size();
  const auto in_turn = [&](std::size_t i) -> Change::OfPoint& {
    return change.changed_points[is_done ? count - 1 - i : i];
  };
  for (std::size_t i = 0; i < count; ++i) {
    // The entries that come next are read ahead, because their points are anywhere in memory.
    constexpr std::size_t kAhead = 12;
    if (i + kAhead < count) expect(points, in_turn(i + kAhead).point);
    Change::OfPoint& of = in_turn(i);
    std::swap(points.slabs[of.point], of.slab);
    std::swap(points.influences[of.point], of.influences);
    std::swap(points.owners[of.point], of.owner);
    std::swap(points.lip_points[of.point], of.lip);
  }
  exchange_in_turn(change.changed_particles, is_done, [&](std::pair<Index, Particle>& of) {
    std::swap(structure.particles[of.first], of.second);
    structure.particles[of.first].revision = structure.revision + 1;
  });
  exchange_in_turn(change.changed_vertices, is_done, [&](Change::OfVertex& of) {
    std::swap(structure.vertex_points.of_mesh[of.mesh][of.vertex], of.point);
    structure.journal.vertices.add({of.mesh, of.vertex});
  });
  exchange_in_turn(change.changed_lips, is_done, [&](std::pair<Index, LipEdge>& of) {
    std::swap(structure.lips[of.first], of.second);
  });
}

}  // namespace

void exchange(Structure& structure, Change& change) {
  const bool is_done = change.appended == nullptr;
  if (is_done) change.appended = std::make_shared<Change::Appended>();
  Change::Appended& appended = *change.appended;
  exchange_changed(structure, change, is_done);
  PointColumns::for_each_column(
      [&](auto& column, auto& tail) { move_tail(column, change.points, is_done, tail); },
      structure.points, appended.points);
  move_tail(structure.particles, change.particles, is_done, appended.particles);
  move_tail(structure.members.joined, change.particles, is_done, appended.joined);
  move_tail(structure.lips, change.lips, is_done, appended.lips);
  std::vector<std::vector<Index>>& vertex_points = structure.vertex_points.of_mesh;
  appended.vertex_points.resize(vertex_points.size());
  for (std::size_t m = 0; m < vertex_points.size(); ++m)
    move_tail(vertex_points[m], change.vertices[m], is_done, appended.vertex_points[m]);
  if (!is_done) change.appended.reset();
  for (Index m = 0; m < vertex_points.size(); ++m)
    for (Index vertex = change.vertices[m]; vertex < vertex_points[m].size(); ++vertex)
      structure.journal.vertices.add({m, vertex});
  for (std::size_t p = change.particles; p < structure.particles.size(); ++p)
    structure.particles[p].revision = structure.revision + 1;
  structure.points.ends = is_done ? change.ends_before : change.ends_after;
  ++structure.revision;
  change.changed_points.for_each(
      [&](const Change::OfPoint& of) { structure.dirty.push_back(of.point); });
  for (Index point = change.points; point < structure.points.count(); ++point)
    structure.dirty.push_back(point);
}

}  // namespace sunder::particles
