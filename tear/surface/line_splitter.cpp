#include "tear/surface/line_splitter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tear/geometry/face_shape.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/mesh_vertices.h"
#include "tear/internal/surface.h"

namespace sunder::tear {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

Index LineSplitter::begin(Index half_edge, double fraction, Rounding rounding) {
  const FaceSplit behind(editor_, half_edge / 3);
  make_room(behind, half_edge, 1);
  NewPoint& made = points_[newest_];
  append_vertices(behind, half_edge, fraction, made);
  const bool is_kept = is_sound(behind, half_edge, made) ||
                       (rounding == Rounding::as_fits && round_aside(behind, half_edge, made));
  if (!is_kept) {
    remove_vertices(made);
    return kNone;
  }
  append_point(made);
  behind_ = split_in_two(half_edge, made.point, made.of_behind.vertex);
  half_edge_ = editor_.surface().twin[Surface::next(half_edge)];
  return made.point;
}

/// A part of a face that is about to be split.
struct LineSplitter::Part {
  Part(const FaceSplit::Corner& a_, const FaceSplit::Corner& b_, const FaceSplit::Corner& c_)
      : a(a_), b(b_), c(c_), normal(tear::normal(a.at, b.at, c.at)) {}

  [[nodiscard]] bool is_sound(const FaceSplit& face) const {
    return face.keeps_winding(a, b, c, normal);
  }
  [[nodiscard]] double shape_squared() const {
    return tear::shape_squared(a.at, b.at, c.at, normal);
  }

  const FaceSplit::Corner &a, &b, &c;
  Place normal;
};

Index LineSplitter::go_on(Index half_edge, double fraction) {
  const NewPoint& last = points_[newest_];
  NewPoint& made = points_[1 - newest_];
  const FaceSplit& face = *last.face_ahead;
  make_room(face, half_edge, 2);
  append_vertices(face, half_edge, fraction, made);
  // The face (u, v, w) is entered through p on u -> v. It loses a corner, v or u; the rest is cut
  // from p to w, or from the new point q to the opposite corner.
  const FaceSplit::Corner& p = last.of_ahead;
  const FaceSplit::Corner& q = made.of_behind;
  const Index entry = last.ahead;
  const FaceSplit::Corner &u = face.corner(entry % 3), &v = face.corner(Surface::next(entry) % 3),
                          &w = face.corner(Surface::previous(entry) % 3);
  const bool loses_v = half_edge == Surface::next(entry);
  const Part lost = loses_v ? Part(p, v, q) : Part(u, p, q);
  const std::array<Part, 2> from_p = {loses_v ? Part(u, p, w) : Part(p, v, w),
                                      loses_v ? Part(p, q, w) : Part(p, w, q)};
  const std::array<Part, 2> from_q = {loses_v ? Part(u, p, q) : Part(p, v, q),
                                      loses_v ? Part(u, q, w) : Part(q, v, w)};
  const auto shape = [](const std::array<Part, 2>& parts) {
    return std::min(parts[0].shape_squared(), parts[1].shape_squared());
  };
  const auto are_sound = [&](const std::array<Part, 2>& parts) {
    return parts[0].is_sound(face) && parts[1].is_sound(face);
  };
  const bool is_better_from_q = shape(from_q) > kBetterShapeFactor * shape(from_p);
  const bool cuts_as_better = are_sound(is_better_from_q ? from_q : from_p);
  if (!made.is_sound || !lost.is_sound(face) ||
      !(cuts_as_better || are_sound(is_better_from_q ? from_p : from_q))) {
    remove_vertices(made);
    return kNone;
  }
  append_point(made);
  split_in_three(half_edge, made, is_better_from_q == cuts_as_better);
  newest_ = 1 - newest_;
  return made.point;
}

void LineSplitter::end() {
  const NewPoint& last = points_[newest_];
  if (last.ahead != kNone) join_behind(split_in_two(last.ahead, last.point, last.of_ahead.vertex));
}

void LineSplitter::make_room(const FaceSplit& behind, Index half_edge, Index triangles) {
  const Index mesh = behind.mesh(),
              influences = editor_.room.influence_count(mesh, behind.vertices());
  editor_.room.make_for_vertices(mesh, 2, 2 * influences);
  editor_.room.make_for_triangles(mesh, triangles + 1);
  editor_.room.make_for_changes(4);
  const Index twin = editor_.surface().twin[half_edge];
  const Index mesh_ahead = twin == kNone ? mesh : editor_.surface().triangle(twin / 3).mesh;
  if (mesh_ahead == mesh) return;
  // The columns that all meshes share need room for the rows of both.
  editor_.room.make_for_vertices(mesh_ahead, 3, influences);
  editor_.room.make_for_triangles(mesh_ahead, triangles + 2);
}

void LineSplitter::append_vertices(const FaceSplit& behind, Index half_edge, double fraction,
                                   NewPoint& made) {
  const auto& meshes = editor_.character().meshes;
  const Birth birth = behind.birth_between(half_edge % 3, Surface::next(half_edge) % 3, fraction);
  made.mesh = behind.mesh();
  made.is_sound = true;
  made.face_ahead.reset();
  const Index vertex = editor_.births.append(made.mesh, birth);
  made.of_behind =
      made.of_ahead = {vertex, birth.barycentric, place_of(meshes[made.mesh].positions[vertex])};
  made.ahead = editor_.surface().twin[half_edge];
  if (made.ahead == kNone) return;
  const FaceSplit& ahead = made.face_ahead.emplace(editor_, made.ahead / 3);
  const Index at_begin = Surface::next(made.ahead), at_end = made.ahead;
  const Birth birth_ahead = ahead.birth_between(at_begin % 3, at_end % 3, fraction);
  made.of_ahead.barycentric = birth_ahead.barycentric;
  if (ahead.mesh() != made.mesh ||
      ahead.vertices()[at_begin % 3] != behind.vertices()[half_edge % 3] ||
      ahead.vertices()[at_end % 3] != behind.vertices()[Surface::next(half_edge) % 3]) {
    made.of_ahead.vertex = editor_.births.append(ahead.mesh(), birth_ahead);
    copy_surface_point(meshes[made.mesh], made.of_behind.vertex, made.of_ahead.vertex,
                       editor_.mutable_mesh(ahead.mesh()));
    editor_.births.set_original_of_newest(ahead.mesh(), {made.mesh, made.of_behind.vertex});
  }
  made.is_sound = ahead.keeps_winding(at_begin % 3, made.of_ahead) &&
                  ahead.keeps_winding(at_end % 3, made.of_ahead);
}

bool LineSplitter::is_sound(const FaceSplit& behind, Index half_edge, const NewPoint& made) {
  return made.is_sound && behind.keeps_winding(half_edge % 3, made.of_behind) &&
         behind.keeps_winding(Surface::next(half_edge) % 3, made.of_behind);
}

bool LineSplitter::round_aside(const FaceSplit& behind, Index half_edge, NewPoint& made) {
  Vec3f& stored = editor_.mutable_mesh(made.mesh).positions[made.of_behind.vertex];
  const Vec3f nearest = stored;
  const auto place = [&](Index number) {
    Vec3f at = nearest;
    for (Index k = 0; k < 3; ++k, number /= 3)
      if (number % 3 != 0) at[k] = std::nextafter(at[k], number % 3 == 1 ? -kInfinity : kInfinity);
    return at;
  };
  constexpr Index kPlaces = 27;
  for (Index number = 1; number < kPlaces; ++number) {
    made.of_behind.at = made.of_ahead.at = place_of(place(number));
    if (made.face_ahead)
      made.is_sound = made.face_ahead->keeps_winding(made.ahead % 3, made.of_ahead) &&
                      made.face_ahead->keeps_winding(Surface::next(made.ahead) % 3, made.of_ahead);
    if (!is_sound(behind, half_edge, made)) continue;
    stored = place(number);
    if (made.is_two_vertices())
      editor_.mutable_mesh(made.face_ahead->mesh()).positions[made.of_ahead.vertex] = stored;
    return true;
  }
  return false;
}

void LineSplitter::remove_vertices(const NewPoint& made) {
  if (made.is_two_vertices()) editor_.births.remove_newest(made.face_ahead->mesh());
  editor_.births.remove_newest(made.mesh);
}

void LineSplitter::append_point(NewPoint& made) {
  made.point = editor_.connectivity.append_point();
  const Index side = editor_.surface().side(made.point);
  editor_.sides.write_to_new(made.mesh, made.of_behind.vertex, side);
  if (made.is_two_vertices())
    editor_.sides.write_to_new(made.face_ahead->mesh(), made.of_ahead.vertex, side);
}

LineSplitter::EdgeParts LineSplitter::split_in_two(Index half_edge, Index point, Index vertex) {
  // (a, b, c) -> (a, p, c) in place, (p, b, c).
  Surface& surface = editor_.connectivity.surface();
  const Index ab = half_edge, bc = Surface::next(ab), ca = Surface::previous(ab);
  const Triangle before = editor_.connectivity.vertices_of(ab / 3);
  const Index a = surface.corner_point[ab], b = surface.corner_point[bc],
              c = surface.corner_point[ca];
  const Index twin_bc = surface.twin[bc];
  editor_.log.keep(ab / 3);
  if (twin_bc != kNone) editor_.log.keep(twin_bc / 3);
  const Index pb = 3 * editor_.connectivity.append_part(ab / 3, {point, b, c},
                                                        {vertex, before[bc % 3], before[ca % 3]});
  const Index new_bc = pb + 1, cp = pb + 2;
  editor_.connectivity.set_corner(bc, point, vertex);
  editor_.opened_edges.move(bc, new_bc);
  editor_.opened_edges.split(ab, pb);
  editor_.connectivity.join(new_bc, twin_bc);
  editor_.connectivity.join(bc, cp);
  editor_.connectivity.join(pb, kNone);
  editor_.connectivity.join(ab, kNone);
  surface.point_corner[point] = pb;
  surface.point_corner[a] = ab;
  surface.point_corner[b] = new_bc;
  surface.point_corner[c] = ca;
  return {ab, pb};
}

void LineSplitter::split_in_three(Index half_edge, const NewPoint& to, bool cuts_from_q) {
  const Surface& surface = editor_.surface();
  const NewPoint& from = points_[newest_];
  const Index uv = from.ahead, vw = Surface::next(uv), wu = Surface::previous(uv);
  const Triangle before = editor_.connectivity.vertices_of(uv / 3);
  const auto corner = [&](Index at) {
    return PartCorner{surface.corner_point[at], before[at % 3]};
  };
  const CrossedFace face = {uv,
                            corner(uv),
                            corner(vw),
                            corner(wu),
                            {from.point, from.of_ahead.vertex},
                            {to.point, to.of_behind.vertex}};
  const bool was_opened = editor_.opened_edges.remove(half_edge);
  editor_.log.keep(uv / 3);
  const ThreeParts parts =
      half_edge == vw ? cut_off_v(face, cuts_from_q) : cut_off_u(face, cuts_from_q);
  join_behind(parts.entry);
  editor_.connectivity.join(parts.exit.to_point, kNone);
  editor_.connectivity.join(parts.exit.from_point, kNone);
  if (was_opened) editor_.opened_edges.add(parts.exit.to_point, parts.exit.from_point);
  half_edge_ = parts.along;
  behind_ = parts.exit;
}

LineSplitter::ThreeParts LineSplitter::cut_off_v(const CrossedFace& face, bool cuts_from_q) {
  Connectivity& connectivity = editor_.connectivity;
  const auto& [uv, u, v, w, p, q] = face;
  const Index vw = Surface::next(uv);
  const Index pv = append_part(uv / 3, p, v, q), vq = pv + 1, qp = pv + 2;
  connectivity.set_point_corner(v.point, vq);
  connectivity.set_point_corner(q.point, qp);
  if (cuts_from_q) {
    const Index up = append_part(uv / 3, u, p, q), pq = up + 1, qu = up + 2;
    connectivity.set_corner(vw, q.point, q.vertex);
    connectivity.join(uv, qu);
    connectivity.join(pq, qp);
    return {{up, pv}, {vq, vw}, pq};
  }
  const Index pq = append_part(uv / 3, p, q, w), qw = pq + 1, wp = pq + 2;
  connectivity.set_corner(vw, p.point, p.vertex);
  connectivity.join(vw, wp);
  connectivity.join(pq, qp);
  return {{uv, pv}, {vq, qw}, pq};
}

LineSplitter::ThreeParts LineSplitter::cut_off_u(const CrossedFace& face, bool cuts_from_q) {
  Connectivity& connectivity = editor_.connectivity;
  const auto& [uv, u, v, w, p, q] = face;
  const Index wu = Surface::previous(uv);
  const Index up = append_part(uv / 3, u, p, q), pq = up + 1, qu = up + 2;
  connectivity.set_point_corner(u.point, up);
  connectivity.set_point_corner(q.point, qu);
  if (cuts_from_q) {
    const Index pv = append_part(uv / 3, p, v, q), vq = pv + 1, qp = pv + 2;
    connectivity.set_corner(uv, q.point, q.vertex);
    connectivity.join(uv, vq);
    connectivity.join(pq, qp);
    return {{up, pv}, {wu, qu}, pq};
  }
  const Index pw = append_part(uv / 3, p, w, q), wq = pw + 1, qp = pw + 2;
  connectivity.set_corner(uv, p.point, p.vertex);
  connectivity.join(wu, pw);
  connectivity.join(pq, qp);
  return {{up, uv}, {wq, qu}, pq};
}

Index LineSplitter::append_part(Index of, const PartCorner& a, const PartCorner& b,
                                const PartCorner& c) {
  const Index triangle = editor_.connectivity.append_part(of, {a.point, b.point, c.point},
                                                          {a.vertex, b.vertex, c.vertex});
  editor_.origins.settle_newest();
  return 3 * triangle;
}

void LineSplitter::join_behind(const EdgeParts& ahead) {
  editor_.connectivity.join(behind_.to_point, ahead.from_point);
  editor_.connectivity.join(behind_.from_point, ahead.to_point);
}

}  // namespace sunder::tear
