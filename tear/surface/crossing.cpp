#include "tear/surface/crossing.h"

#include <algorithm>

#include "tear/geometry/face_shape.h"
#include "tear/internal/surface.h"
#include "tear/surface/mesh_vertices.h"

namespace sunder::tear {

Index SurfaceEditor::split_edge(Index half_edge, double fraction) {
  Crossing crossing(*this);
  const Index point = crossing.begin(half_edge, fraction);
  if (point != kNone) crossing.end();
  return point;
}

Index SurfaceEditor::Crossing::begin(Index half_edge, double fraction) {
  const FaceSplit behind(editor_, half_edge / 3);
  make_room(behind, half_edge, 1);
  NewPoint& made = points_[newest_];
  append_vertices(behind, half_edge, fraction, made);
  const bool is_sound = made.is_sound && behind.keeps_winding(half_edge % 3, made.of_behind) &&
                        behind.keeps_winding(Surface::next(half_edge) % 3, made.of_behind);
  if (!is_sound) {
    remove_vertices(made);
    return kNone;
  }
  append_point(made);
  behind_ = split_in_two(half_edge, made.point, made.of_behind.vertex);
  half_edge_ = editor_.surface_.twin[Surface::next(half_edge)];
  return made.point;
}

/// A part of a face that is to be split.
struct SurfaceEditor::Crossing::Part {
  Part(const FaceSplit::Corner& a_, const FaceSplit::Corner& b_, const FaceSplit::Corner& c_)
      : a(a_), b(b_), c(c_), normal(tear::normal(a.at, b.at, c.at)) {}

  [[nodiscard]] bool is_sound(const FaceSplit& face) const { return face.keeps_winding(a, b, c, normal); }
  [[nodiscard]] double shape_squared() const { return tear::shape_squared(a.at, b.at, c.at, normal); }

  const FaceSplit::Corner &a, &b, &c;
  Place normal;
};

Index SurfaceEditor::Crossing::go_on(Index half_edge, double fraction) {
  const NewPoint& last = points_[newest_];
  NewPoint& made = points_[1 - newest_];
  const FaceSplit& face = *last.face_ahead;
  make_room(face, half_edge, 2);
  append_vertices(face, half_edge, fraction, made);
  // The face (u, v, w) is entered through p on u -> v. It loses a corner, v or u; what is left is cut from p to w, or from the new
  // point q to the other one.
  const FaceSplit::Corner& p = last.of_ahead;
  const FaceSplit::Corner& q = made.of_behind;
  const Index entry = last.ahead;
  const FaceSplit::Corner &u = face.corner(entry % 3), &v = face.corner(Surface::next(entry) % 3),
                          &w = face.corner(Surface::previous(entry) % 3);
  const bool loses_v = half_edge == Surface::next(entry);
  const Part lost = loses_v ? Part(p, v, q) : Part(u, p, q);
  const std::array<Part, 2> from_p = {loses_v ? Part(u, p, w) : Part(p, v, w), loses_v ? Part(p, q, w) : Part(p, w, q)};
  const std::array<Part, 2> from_q = {loses_v ? Part(u, p, q) : Part(p, v, q), loses_v ? Part(u, q, w) : Part(q, v, w)};
  const auto shape = [](const std::array<Part, 2>& parts) { return std::min(parts[0].shape_squared(), parts[1].shape_squared()); };
  const auto are_sound = [&](const std::array<Part, 2>& parts) { return parts[0].is_sound(face) && parts[1].is_sound(face); };
  const bool is_better_from_q = shape(from_q) > kBetterShape * shape(from_p);
  const bool cuts_as_better = are_sound(is_better_from_q ? from_q : from_p);
  if (!made.is_sound || !lost.is_sound(face) || !(cuts_as_better || are_sound(is_better_from_q ? from_p : from_q))) {
    remove_vertices(made);
    return kNone;
  }
  append_point(made);
  split_in_three(half_edge, made, is_better_from_q == cuts_as_better);
  newest_ = 1 - newest_;
  return made.point;
}

void SurfaceEditor::Crossing::end() {
  const NewPoint& last = points_[newest_];
  if (last.ahead != kNone) join_behind(split_in_two(last.ahead, last.point, last.of_ahead.vertex));
}

void SurfaceEditor::Crossing::make_room(const FaceSplit& behind, Index half_edge, Index triangles) {
  const Index mesh = behind.mesh(), influences = editor_.influence_count(mesh, behind.vertices());
  editor_.make_room_for_vertices(mesh, 2, 2 * influences);
  editor_.make_room_for_triangles(mesh, triangles + 1);
  editor_.make_room_in_log(4);
  const Index twin = editor_.surface_.twin[half_edge];
  const Index mesh_ahead = twin == kNone ? mesh : editor_.surface_.triangle(twin / 3).mesh;
  if (mesh_ahead == mesh) return;
  editor_.make_room_for_vertices(mesh_ahead, 1, influences);
  editor_.make_room_for_triangles(mesh_ahead, 1);
}

void SurfaceEditor::Crossing::append_vertices(const FaceSplit& behind, Index half_edge, double fraction, NewPoint& made) {
  auto& meshes = editor_.character_.meshes;
  const Birth birth = behind.birth_between(half_edge % 3, Surface::next(half_edge) % 3, fraction);
  made.mesh = behind.mesh();
  made.is_sound = true;
  made.face_ahead.reset();
  const Index vertex = editor_.append_vertex(made.mesh, birth);
  made.of_behind = made.of_ahead = {vertex, birth.barycentric, place_of(meshes[made.mesh].positions[vertex])};
  made.ahead = editor_.surface_.twin[half_edge];
  if (made.ahead == kNone) return;
  const FaceSplit& ahead = made.face_ahead.emplace(editor_, made.ahead / 3);
  const Index at_begin = Surface::next(made.ahead), at_end = made.ahead;
  const Birth birth_ahead = ahead.birth_between(at_begin % 3, at_end % 3, fraction);
  made.of_ahead.barycentric = birth_ahead.barycentric;
  if (ahead.mesh() != made.mesh || ahead.vertices()[at_begin % 3] != behind.vertices()[half_edge % 3] ||
      ahead.vertices()[at_end % 3] != behind.vertices()[Surface::next(half_edge) % 3]) {
    made.of_ahead.vertex = editor_.append_vertex(ahead.mesh(), birth_ahead);
    copy_surface_point(meshes[made.mesh], made.of_behind.vertex, made.of_ahead.vertex, meshes[ahead.mesh()]);
    editor_.records_[ahead.mesh()].back().original = {made.mesh, made.of_behind.vertex};
  }
  made.is_sound = ahead.keeps_winding(at_begin % 3, made.of_ahead) && ahead.keeps_winding(at_end % 3, made.of_ahead);
}

void SurfaceEditor::Crossing::remove_vertices(const NewPoint& made) {
  if (made.is_two_vertices()) editor_.remove_newest_vertex(made.face_ahead->mesh());
  editor_.remove_newest_vertex(made.mesh);
}

void SurfaceEditor::Crossing::append_point(NewPoint& made) {
  made.point = editor_.append_point();
  const Index side = editor_.surface_.side(made.point);
  editor_.write_side_of_new(made.mesh, made.of_behind.vertex, side);
  if (made.is_two_vertices()) editor_.write_side_of_new(made.face_ahead->mesh(), made.of_ahead.vertex, side);
}

SurfaceEditor::Crossing::EdgeParts SurfaceEditor::Crossing::split_in_two(Index half_edge, Index point, Index vertex) {
  // (a, b, c) -> (a, p, c) in place, (p, b, c).
  Surface& surface = editor_.surface_;
  const Index ab = half_edge, bc = Surface::next(ab), ca = Surface::previous(ab);
  const Triangle before = editor_.vertices_of(ab / 3);
  const Index a = surface.corner_point[ab], b = surface.corner_point[bc], c = surface.corner_point[ca];
  const Index twin_bc = surface.twin[bc];
  editor_.log_triangle(ab / 3);
  if (twin_bc != kNone) editor_.log_triangle(twin_bc / 3);
  const Index pb = 3 * editor_.append_triangle(ab / 3, {point, b, c}, {vertex, before[bc % 3], before[ca % 3]});
  const Index new_bc = pb + 1, cp = pb + 2;
  editor_.set_corner(bc, point, vertex);
  editor_.move_opened(bc, new_bc);
  if (editor_.keeps_opened_ && editor_.opened_.count(ab) != 0) editor_.opened_.insert(pb);
  editor_.join(new_bc, twin_bc);
  editor_.join(bc, cp);
  editor_.join(pb, kNone);
  editor_.join(ab, kNone);
  surface.point_corner[point] = pb;
  surface.point_corner[a] = ab;
  surface.point_corner[b] = new_bc;
  surface.point_corner[c] = ca;
  return {ab, pb};
}

void SurfaceEditor::Crossing::split_in_three(Index half_edge, const NewPoint& to, bool cuts_from_q) {
  Surface& surface = editor_.surface_;
  const NewPoint& from = points_[newest_];
  const Index uv = from.ahead, vw = Surface::next(uv), wu = Surface::previous(uv), face = uv / 3;
  const Triangle before = editor_.vertices_of(face);
  const Index vertex_u = before[uv % 3], vertex_v = before[vw % 3], vertex_w = before[wu % 3];
  const Index vertex_p = from.of_ahead.vertex, vertex_q = to.of_behind.vertex;
  const Index u = surface.corner_point[uv], v = surface.corner_point[vw], w = surface.corner_point[wu];
  const Index p = from.point, q = to.point;
  const bool was_opened = editor_.keeps_opened_ && editor_.opened_.erase(half_edge) > 0;
  editor_.log_triangle(face);
  // The third edge stays where it is, so that the face across it need not know.
  EdgeParts entry, exit;
  if (half_edge == vw) {
    const Index pv = append_part(face, {p, v, q}, {vertex_p, vertex_v, vertex_q}), vq = pv + 1, qp = pv + 2;
    surface.point_corner[v] = vq;
    if (cuts_from_q) {
      const Index up = append_part(face, {u, p, q}, {vertex_u, vertex_p, vertex_q}), pq = up + 1, qu = up + 2;
      editor_.set_corner(vw, q, vertex_q);
      editor_.join(uv, qu);
      entry = {up, pv};
      exit = {vq, vw};
      half_edge_ = pq;
    } else {
      const Index pq = append_part(face, {p, q, w}, {vertex_p, vertex_q, vertex_w}), qw = pq + 1, wp = pq + 2;
      editor_.set_corner(vw, p, vertex_p);
      editor_.join(vw, wp);
      entry = {uv, pv};
      exit = {vq, qw};
      half_edge_ = pq;
    }
    editor_.join(half_edge_, qp);
    surface.point_corner[q] = qp;
  } else {
    const Index up = append_part(face, {u, p, q}, {vertex_u, vertex_p, vertex_q}), pq = up + 1, qu = up + 2;
    surface.point_corner[u] = up;
    Index qp = kNone;
    if (cuts_from_q) {
      const Index pv = append_part(face, {p, v, q}, {vertex_p, vertex_v, vertex_q}), vq = pv + 1;
      qp = pv + 2;
      editor_.set_corner(uv, q, vertex_q);
      editor_.join(uv, vq);
      entry = {up, pv};
      exit = {wu, qu};
    } else {
      const Index pw = append_part(face, {p, w, q}, {vertex_p, vertex_w, vertex_q}), wq = pw + 1;
      qp = pw + 2;
      editor_.set_corner(uv, p, vertex_p);
      editor_.join(wu, pw);
      entry = {up, uv};
      exit = {wq, qu};
    }
    half_edge_ = pq;
    editor_.join(pq, qp);
    surface.point_corner[q] = qu;
  }
  join_behind(entry);
  editor_.join(exit.to_point, kNone);
  editor_.join(exit.from_point, kNone);
  if (was_opened) editor_.opened_.insert({exit.to_point, exit.from_point});
  behind_ = exit;
}

Index SurfaceEditor::Crossing::append_part(Index of, const std::array<Index, 3>& points, const Triangle& vertices) {
  const Index triangle = editor_.append_triangle(of, points, vertices);
  editor_.parents_.back() |= kSettled;
  return 3 * triangle;
}

void SurfaceEditor::Crossing::join_behind(const EdgeParts& ahead) {
  editor_.join(behind_.to_point, ahead.from_point);
  editor_.join(behind_.from_point, ahead.to_point);
}

}  // namespace sunder::tear
