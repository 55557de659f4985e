#include "particles/clusters/structure.h"

#include <iterator>

#include "particles/clusters/band.h"
#include "particles/clusters/gradients.h"
#include "particles/clusters/pair_changes.h"

namespace sunder::particles {
namespace {

/// Moves what an array has beyond `count` into `tail`, or appends what is there. @param is_there  whether the array is to lose it.
template <class T>
void move_tail(std::vector<T>& values, std::size_t count, bool is_there, std::vector<T>& tail) {
  if (is_there) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(count);
    tail.assign(std::make_move_iterator(first), std::make_move_iterator(values.end()));
    values.erase(first, values.end());
  } else {
    values.insert(values.end(), std::make_move_iterator(tail.begin()), std::make_move_iterator(tail.end()));
    tail.clear();
  }
}

/// Not twice as much, as arrays do by themselves.
template <class T>
void reserve_eighth(std::vector<T>& values, std::size_t count) {
  if (values.capacity() < count) values.reserve(count + count / 8 + 1024);
}

}  // namespace

Structure::Structure() : pairs(std::make_unique<PairChanges>()), gradients(std::make_unique<Gradients>()) {}
Structure::~Structure() = default;

void Structure::share_vertex(Index mesh, Index vertex, Index point, Index other) {
  std::vector<Index>& points = shared_vertices[{mesh, vertex}];
  for (const Index each : {point, other})
    if (std::find(points.begin(), points.end(), each) == points.end()) points.push_back(each);
}

void Structure::make_room(std::size_t points) {
  reserve_eighth(positions, points);
  reserve_eighth(vertices, points);
  reserve_eighth(slabs, points);
  reserve_eighth(influences, points);
  reserve_eighth(lip_points, points);
  if (beside.size() < points) beside.resize(points + points / 8 + 1024);
  if (scratch.work_of.size() < points) scratch.work_of.resize(points + points / 8 + 1024);
  front.grow(points);
  band_front.grow(points);
  for (Marks* marks : {&scratch.worked, &scratch.logged_points, &scratch.seen, &scratch.given}) marks->grow(points);
}

void Structure::prepare_for_tears(Index triangles) {
  triangle_count = triangles;
  make_room(point_count() + 1);
  lip_points.resize(point_count());
  memberships_end = memberships.size();
  reserve_eighth(memberships, memberships_end + 1);
  for (std::vector<Index>& points : vertex_points) reserve_eighth(points, points.size() + 1);
}

void Structure::put_on_lip(Index point, Index tear, Side side) {
  LipPoint& lip = lip_points[point];
  if (lip.tear == kNone || lip.tear == tear) {
    lip.tear = tear;
    lip.side = side;
    return;
  }
  OnLip behind = lip;
  if (tear > lip.tear) {  // newer
    lip.tear = tear;
    lip.side = side;
  } else {
    behind = {tear, side, lip.older};
  }
  lip.older = static_cast<Index>(older_lips.size());
  older_lips.push_back(behind);
}

std::vector<Index> Structure::members_of(Index particle) const {
  std::vector<Index> found;
  const auto add = [&](Index point) {
    if (point < point_count() && find(point, particle) != nullptr) found.push_back(point);
  };
  if (particle + 1 < first_member.size())
    for (Index m = first_member[particle]; m < first_member[particle + 1]; ++m) add(members[m]);
  for (const Index point : joined[particle]) add(point);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void exchange(Structure& structure, Change& change) {
  const bool is_done = change.appended == nullptr;
  if (is_done) change.appended = std::make_shared<Change::Appended>();
  Change::Appended& appended = *change.appended;
  const auto exchange_values = [&] {
    for (Change::OfPoint& of : change.changed_points) {
      std::swap(structure.slabs[of.point], of.slab);
      std::swap(structure.influences[of.point], of.influences);
      std::swap(structure.lip_points[of.point], of.lip);
    }
    for (auto& [particle, before] : change.changed_particles) std::swap(structure.particles[particle], before);
    // These may be there several times: taken back from the last, done again from the first.
    const auto exchange_in_turn = [&](auto& changes, auto exchange_one) {
      if (is_done)
        std::for_each(changes.rbegin(), changes.rend(), exchange_one);
      else
        std::for_each(changes.begin(), changes.end(), exchange_one);
    };
    exchange_in_turn(change.changed_vertices,
                     [&](Change::OfVertex& of) { std::swap(structure.vertex_points[of.mesh][of.vertex], of.point); });
    exchange_in_turn(change.changed_lips, [&](std::pair<Index, LipEdge>& of) { std::swap(structure.lips[of.first], of.second); });
  };
  exchange_values();
  move_tail(structure.positions, change.points, is_done, appended.positions);
  move_tail(structure.vertices, change.points, is_done, appended.vertices);
  move_tail(structure.slabs, change.points, is_done, appended.slabs);
  move_tail(structure.influences, change.points, is_done, appended.influences);
  move_tail(structure.lip_points, change.points, is_done, appended.lip_points);
  move_tail(structure.particles, change.particles, is_done, appended.particles);
  move_tail(structure.joined, change.particles, is_done, appended.joined);
  move_tail(structure.lips, change.lips, is_done, appended.lips);
  appended.vertex_points.resize(structure.vertex_points.size());
  for (std::size_t m = 0; m < structure.vertex_points.size(); ++m)
    move_tail(structure.vertex_points[m], change.vertices[m], is_done, appended.vertex_points[m]);
  if (!is_done) change.appended.reset();
  structure.memberships_end = is_done ? change.memberships_before : change.memberships_after;
  ++structure.revision;
  for (const Change::OfPoint& of : change.changed_points) structure.dirty.push_back(of.point);
  for (Index point = change.points; point < structure.point_count(); ++point) structure.dirty.push_back(point);
}

}  // namespace sunder::particles
