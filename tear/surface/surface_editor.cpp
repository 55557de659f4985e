#include "tear/surface/surface_editor.h"

#include <algorithm>
#include <cmath>

#include "core/internal/prefetch.h"
#include "tear/internal/surface.h"
#include "tear/surface/face_split.h"
#include "tear/surface/mesh_vertices.h"

namespace sunder::tear {
SurfaceEditor::SurfaceEditor(const Character& source, Character& character)
    : source_(source),
      character_(character),
      surface_(build_surface(character)),
      births_(character.meshes.size()),
      records_(character.meshes.size()),
      exact_(character.meshes.size()),
      exact_first_(character.meshes.size()),
      fillings_(character.meshes.size()),
      filling_serials_(character.meshes.size()),
      appended_triangles_(character.meshes.size()),
      newest_part_(character.meshes.size()),
      newest_entry_(surface_.triangle_count(), kNone),
      spare_sides_(character.meshes.size()) {
  for (const Index side : surface_.source_side) next_side_ = std::max(next_side_, side + 1);
  for (const Mesh& mesh : character.meshes) {
    const auto found = std::find_if(mesh.custom_attributes.begin(), mesh.custom_attributes.end(),
                                    [](const CustomAttribute& a) { return a.name == kTearSideAttribute && a.components == 1; });
    side_attribute_.push_back(found == mesh.custom_attributes.end() ? kNone
                                                                    : static_cast<Index>(found - mesh.custom_attributes.begin()));
  }
  sizes_.reserve(character.meshes.size());
  begin_stage();
}

Triangle SurfaceEditor::vertices_of(Index triangle) const {
  const TriangleRef ref = surface_.triangle(triangle);
  return character_.meshes[ref.mesh].triangles[ref.triangle];
}

void SurfaceEditor::fetch(Index triangle) const {
  prefetch(&surface_.corner_point[3 * std::size_t{triangle}]);
  prefetch(&surface_.twin[3 * std::size_t{triangle}]);
  prefetch(&newest_entry_[triangle]);
  if (triangle >= surface_.first_triangle.back()) return;
  const TriangleRef ref = surface_.triangle(triangle);
  prefetch(&character_.meshes[ref.mesh].triangles[ref.triangle]);
  prefetch(&character_.meshes[ref.mesh].triangle_submesh[ref.triangle]);
  prefetch(&source_.meshes[ref.mesh].triangles[ref.triangle]);
  if (ref.triangle < newest_part_[ref.mesh].size()) prefetch(&newest_part_[ref.mesh][ref.triangle]);
}

void SurfaceEditor::fill(LogEntry& entry) const {
  entry.vertices = vertices_of(entry.triangle);
  for (Index k = 0; k < 3; ++k) {
    const Index point = surface_.corner_point[3 * entry.triangle + k];
    entry.points[k] = point;
    entry.twins[k] = surface_.twin[3 * entry.triangle + k];
    entry.point_corners[k] = point == kNone ? kNone : surface_.point_corner[point];
  }
}

void SurfaceEditor::log_triangle(Index triangle) {
  if (triangle >= logged_since_.triangles) return;
  Index& newest = newest_entry_[triangle];
  if (newest != kNone && newest >= logged_since_.log_length) return;
  const Index previous = newest;
  newest = static_cast<Index>(log_.size());
  LogEntry& entry = log_.emplace_back();
  entry.triangle = triangle;
  entry.previous = previous;
  fill(entry);
}

void SurfaceEditor::restore(const LogEntry& entry) {
  const TriangleRef ref = surface_.triangle(entry.triangle);
  character_.meshes[ref.mesh].triangles[ref.triangle] = entry.vertices;
  for (Index k = 0; k < 3; ++k) {
    surface_.corner_point[3 * entry.triangle + k] = entry.points[k];
    surface_.twin[3 * entry.triangle + k] = entry.twins[k];
    if (entry.points[k] != kNone) surface_.point_corner[entry.points[k]] = entry.point_corners[k];
  }
}

void SurfaceEditor::set_corner(Index corner, Index point, Index vertex) {
  surface_.corner_point[corner] = point;
  const TriangleRef ref = surface_.triangle(corner / 3);
  character_.meshes[ref.mesh].triangles[ref.triangle][corner % 3] = vertex;
}

void SurfaceEditor::join(Index a, Index b) {
  surface_.twin[a] = b;
  if (b != kNone) surface_.twin[b] = a;
}

Index SurfaceEditor::append_triangle(Index like, const std::array<Index, 3>& points, const Triangle& vertices) {
  const TriangleRef ref = surface_.triangle(like);
  Mesh& mesh = character_.meshes[ref.mesh];
  const Index triangle = surface_.triangle_count();
  surface_.appended.push_back({ref.mesh, mesh.triangle_count(), ref.source_triangle});
  newest_entry_.push_back(kNone);
  parents_.push_back(like);
  chain_new_parts();
  appended_triangles_[ref.mesh].push_back(triangle);
  ancestors_.push_back(ancestor(like));
  const Index submesh = mesh.triangle_submesh[ref.triangle];
  mesh.triangles.push_back(vertices);
  mesh.triangle_submesh.push_back(submesh);
  for (Index k = 0; k < 3; ++k) {
    surface_.corner_point.push_back(points[k]);
    surface_.twin.push_back(kNone);
  }
  return triangle;
}

void SurfaceEditor::chain_new_parts() {
  for (Index t = surface_.first_triangle.back() + static_cast<Index>(older_part_.size()); t < surface_.triangle_count(); ++t) {
    const TriangleRef ref = surface_.triangle(t);
    std::vector<Index>& newest = newest_part_[ref.mesh];
    const Index source_count = source_.meshes[ref.mesh].triangle_count();
    if (ref.source_triangle >= newest.size()) newest.resize(std::max(source_count, ref.source_triangle + 1), kNone);
    older_part_.push_back(newest[ref.source_triangle]);
    newest[ref.source_triangle] = t;
  }
}

void SurfaceEditor::unchain_parts_from(Index first) {
  for (; surface_.first_triangle.back() + older_part_.size() > first; older_part_.pop_back()) {
    const TriangleRef ref = surface_.appended[older_part_.size() - 1];
    newest_part_[ref.mesh][ref.source_triangle] = older_part_.back();
  }
}

Index SurfaceEditor::append_point() {
  surface_.point_corner.push_back(kNone);
  surface_.appended_side.push_back(next_side_++);
  return surface_.point_count() - 1;
}

Index SurfaceEditor::append_vertex(Index mesh, const Birth& birth) {
  Mesh& of = character_.meshes[mesh];
  const Triangle& corners = origin_triangle(mesh, birth.triangle);
  births_[mesh].push_back(birth);
  records_[mesh].push_back({{mesh, of.vertex_count()}});
  vertex_mesh_.push_back(mesh);
  const Index vertex = append_interpolated_vertex(corners, birth.barycentric, of);
  if (birth.triangle >= source_.meshes[mesh].triangle_count()) interpolate_born(corners, birth.barycentric, mesh);
  return vertex;
}

void SurfaceEditor::remove_newest_vertex(Index mesh) {
  births_[mesh].pop_back();
  records_[mesh].pop_back();
  vertex_mesh_.pop_back();
  remove_vertices_from(character_.meshes[mesh].vertex_count() - 1, character_.meshes[mesh]);
}

std::array<double, 3> SurfaceEditor::place_in_origin(const TriangleRef& ref, Index vertex) const {
  const Triangle& in_triangle = origin_triangle(ref.mesh, ref.source_triangle);
  if (vertex < source_.meshes[ref.mesh].vertex_count())
    return {vertex == in_triangle[0] ? 1.0 : 0.0, vertex == in_triangle[1] ? 1.0 : 0.0, vertex == in_triangle[2] ? 1.0 : 0.0};
  const Birth& born = birth(ref.mesh, vertex);
  if (born.triangle == ref.source_triangle) return born.barycentric;
  // Parts of two origins share a vertex only where the origins share its parents.
  const Triangle& parents = origin_triangle(ref.mesh, born.triangle);
  std::array<double, 3> result = {0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) result[i] += parents[k] == in_triangle[i] ? born.barycentric[k] : 0.0;
  return result;
}

Index SurfaceEditor::split_triangle(Index triangle, const std::array<double, 3>& barycentric) {
  const FaceSplit split(*this, triangle);
  const Index mesh = split.mesh();
  make_room_for_vertices(mesh, 1, influence_count(mesh, split.vertices()));
  make_room_for_triangles(mesh, 2);
  make_room_in_log(3);
  const Birth birth = split.birth_at(barycentric);
  const Index vertex = append_vertex(mesh, birth);
  const Index corner = 3 * triangle;
  const FaceSplit::Corner made{vertex, birth.barycentric, place_of(character_.meshes[mesh].positions[vertex])};
  if (!split.keeps_winding(0, made) || !split.keeps_winding(1, made) || !split.keeps_winding(2, made)) {
    remove_newest_vertex(mesh);
    return kNone;
  }
  // (a, b, c) -> (a, b, p) in place, (b, c, p), (c, a, p).
  const Triangle& before = split.vertices();
  const Index a = surface_.corner_point[corner], b = surface_.corner_point[corner + 1], c = surface_.corner_point[corner + 2];
  const Index twin_bc = surface_.twin[corner + 1], twin_ca = surface_.twin[corner + 2];
  log_triangle(triangle);
  if (twin_bc != kNone) log_triangle(twin_bc / 3);
  if (twin_ca != kNone) log_triangle(twin_ca / 3);
  const Index p = append_point();
  write_side_of_new(mesh, vertex, surface_.side(p));
  const Index at_bc = 3 * append_triangle(triangle, {b, c, p}, {before[1], before[2], vertex});
  const Index at_ca = 3 * append_triangle(triangle, {c, a, p}, {before[2], before[0], vertex});
  set_corner(corner + 2, p, vertex);
  move_opened(corner + 1, at_bc);
  move_opened(corner + 2, at_ca);
  join(at_bc, twin_bc);
  join(at_ca, twin_ca);
  join(corner + 1, at_bc + 2);
  join(at_bc + 1, at_ca + 2);
  join(at_ca + 1, corner + 2);
  surface_.point_corner[p] = corner + 2;
  surface_.point_corner[a] = corner;
  surface_.point_corner[b] = corner + 1;
  surface_.point_corner[c] = at_ca;
  return p;
}

void SurfaceEditor::begin_opening(bool keeps_opened) {
  keeps_opened_ = keeps_opened;
  opened_.clear();
}

std::vector<Index> SurfaceEditor::opened() const {
  std::vector<Index> borders;
  for (const Index h : opened_)
    if (h < surface_.twin.size() && surface_.twin[h] == kNone && surface_.corner_point[h] != kNone) borders.push_back(h);
  std::sort(borders.begin(), borders.end());
  return borders;
}

void SurfaceEditor::move_opened(Index from, Index to) {
  if (keeps_opened_ && opened_.erase(from) > 0) opened_.insert(to);
}

void SurfaceEditor::cut_edge(Index half_edge) {
  const Index twin = surface_.twin[half_edge];
  if (twin == kNone) return;
  if (keeps_opened_) opened_.insert({half_edge, twin});
  make_room_in_log(2);
  log_triangle(half_edge / 3);
  log_triangle(twin / 3);
  surface_.twin[half_edge] = kNone;
  surface_.twin[twin] = kNone;
}

Index SurfaceEditor::separate_fan(std::span<const Index> corners, std::span<const Index> remaining) {
  const Index old_point = surface_.corner_point[corners.front()];
  const auto is_used_elsewhere = [&](Index mesh, Index vertex) {
    const auto& is_shared = surface_.is_shared_vertex[mesh];
    if (vertex < is_shared.size() && is_shared[vertex]) return true;
    const auto is_at = [&](Index c) { return vertex_at(c) == vertex && surface_.triangle(c / 3).mesh == mesh; };
    return std::any_of(remaining.begin(), remaining.end(), [&](Index other) {
      if (is_at(other)) return true;
      bool used = false;
      surface_.for_each_in_fan(other, [&](Index c) { used = used || is_at(c); });
      return used;
    });
  };

  make_room_in_log(corners.size());
  Index last_vertex = kNone;
  for (const Index c : corners) {
    if (vertex_at(c) == last_vertex) continue;
    last_vertex = vertex_at(c);
    const Index mesh = surface_.triangle(c / 3).mesh;
    make_room_for_vertices(mesh, static_cast<Index>(corners.size()),
                           static_cast<Index>(corners.size() * character_.meshes[mesh].weights.of(last_vertex).size()));
  }
  struct Duplicate {
    Index mesh, vertex, copy;
  };
  ScratchVector<Duplicate> duplicates(&scratch_);
  duplicates.reserve(corners.size());
  for (const Index c : corners) log_triangle(c / 3);
  const Index point = append_point();
  for (const Index c : corners) {
    const TriangleRef ref = surface_.triangle(c / 3);
    const Index mesh = ref.mesh;
    Index& of_corner = character_.meshes[mesh].triangles[ref.triangle][c % 3];
    const Index vertex = of_corner;
    auto known = std::find_if(duplicates.begin(), duplicates.end(),
                              [&](const Duplicate& d) { return d.mesh == mesh && d.vertex == vertex; });
    if (known == duplicates.end()) {
      Index copy = vertex;
      if (is_used_elsewhere(mesh, vertex)) {
        copy = append_duplicate(mesh, vertex, c);
        write_side_of_new(mesh, copy, surface_.side(point));
      } else {
        write_side(mesh, vertex, surface_.side(point));
      }
      known = duplicates.insert(duplicates.end(), {mesh, vertex, copy});
    }
    surface_.corner_point[c] = point;
    of_corner = known->copy;
  }
  surface_.point_corner[point] = corners.front();
  if (!remaining.empty()) surface_.point_corner[old_point] = remaining.front();
  return point;
}

Index SurfaceEditor::append_duplicate(Index mesh, Index vertex, Index corner) {
  const bool is_of_source = vertex < source_.meshes[mesh].vertex_count();
  const TriangleRef ref = surface_.triangle(corner / 3);
  births_[mesh].push_back(is_of_source ? Birth{ref.source_triangle, place_in_origin(ref, vertex)} : birth(mesh, vertex));
  records_[mesh].push_back(record_of(mesh, vertex));
  vertex_mesh_.push_back(mesh);
  return append_vertex_copy(vertex, character_.meshes[mesh]);
}

Index SurfaceEditor::separate_left(Index arriving, Index leaving, Index across_arriving, Index across_leaving) {
  for (const Index h : {arriving, leaving, across_arriving, across_leaving})
    if (h == kNone || surface_.twin[h] != kNone) return kNone;
  const Index mesh = surface_.triangle(leaving / 3).mesh, vertex = vertex_at(leaving);
  const auto leads_to = [&](Index first, Index last, Index& count) {
    for (Index c = first; c != kNone; c = surface_.rotate_ccw(c)) {
      if (surface_.triangle(c / 3).mesh != mesh || vertex_at(c) != vertex) return false;
      ++count;
      if (surface_.rotate_ccw(c) == kNone) return c == last;
    }
    return false;
  };
  Index left = 0, right = 0;
  if (!leads_to(leaving, Surface::next(arriving), left) || !leads_to(across_arriving, Surface::next(across_leaving), right))
    return kNone;
  make_room_in_log(left);
  make_room_for_vertices(mesh, 1, static_cast<Index>(character_.meshes[mesh].weights.of(vertex).size()));
  for (Index c = leaving; c != kNone; c = surface_.rotate_ccw(c)) log_triangle(c / 3);
  const Index old_point = surface_.corner_point[leaving], point = append_point();
  const Index copy = append_duplicate(mesh, vertex, leaving);
  write_side_of_new(mesh, copy, surface_.side(point));
  for (Index c = leaving; c != kNone; c = surface_.rotate_ccw(c)) set_corner(c, point, copy);
  surface_.point_corner[point] = leaving;
  surface_.point_corner[old_point] = across_arriving;
  return point;
}

void SurfaceEditor::retire_triangle(Index triangle) {
  make_room_in_log(1);
  log_triangle(triangle);
  const Index vertex = vertices_of(triangle)[0];
  for (Index k = 0; k < 3; ++k) {
    set_corner(3 * triangle + k, kNone, vertex);
    surface_.twin[3 * triangle + k] = kNone;
  }
}

bool SurfaceEditor::flip_edge(Index half_edge) {
  const Index ab = half_edge, bc = Surface::next(ab), ca = Surface::previous(ab);
  const Index ba = surface_.twin[ab];
  if (ba == kNone) return false;
  const Index ad = Surface::next(ba), db = Surface::previous(ba);
  const Index f = ab / 3, g = ba / 3;
  const TriangleRef ref_f = surface_.triangle(f), ref_g = surface_.triangle(g);
  const bool is_one_triangle = ref_f.mesh == ref_g.mesh && ref_f.source_triangle == ref_g.source_triangle &&
                               vertex_at(ab) == vertex_at(ad) && vertex_at(bc) == vertex_at(ba);
  if (!is_one_triangle) return false;
  const Index a = surface_.corner_point[ab], b = surface_.corner_point[bc];
  const Index c = surface_.corner_point[ca], d = surface_.corner_point[db];
  if (c == d || surface_.find_half_edge(c, d) != kNone || surface_.find_half_edge(d, c) != kNone) return false;

  // Both new faces must cover a part of the source triangle, and of the bind surface as its rounded positions have it.
  const auto place_a = source_barycentric(ab), place_b = source_barycentric(bc), place_c = source_barycentric(ca),
             place_d = source_barycentric(db);
  const double whole = covered_part(place_a, place_b, place_c) + covered_part(place_b, place_a, place_d);
  const double least_part = std::max(kLeastPart, 1e-9 * whole);
  if (!(covered_part(place_a, place_d, place_c) > least_part) || !(covered_part(place_b, place_c, place_d) > least_part))
    return false;
  const Index vertex_a = vertex_at(ab), vertex_b = vertex_at(bc), vertex_c = vertex_at(ca), vertex_d = vertex_at(db);
  const auto normal_of = [&](const Triangle& triangle) { return normal(*this, ref_f.mesh, triangle); };
  const Place of_origin = normal_of(origin_triangle(ref_f.mesh, ref_f.source_triangle));
  const Place before = normal_of({vertex_a, vertex_b, vertex_c});
  const double least = 1e-9 * std::sqrt(dot(before, before) * dot(of_origin, of_origin));
  if (!(dot(normal_of({vertex_a, vertex_d, vertex_c}), of_origin) > least) ||
      !(dot(normal_of({vertex_b, vertex_c, vertex_d}), of_origin) > least))
    return false;

  const Index twin_bc = surface_.twin[bc], twin_ad = surface_.twin[ad];
  make_room_in_log(4);
  log_triangle(f);
  log_triangle(g);
  if (twin_bc != kNone) log_triangle(twin_bc / 3);
  if (twin_ad != kNone) log_triangle(twin_ad / 3);
  set_corner(bc, d, vertex_d);
  set_corner(ad, c, vertex_c);
  move_opened(bc, ba);
  move_opened(ad, ab);
  join(ab, twin_ad);
  join(ba, twin_bc);
  join(bc, ad);
  surface_.point_corner[a] = ab;
  surface_.point_corner[b] = ba;
  surface_.point_corner[c] = ca;
  surface_.point_corner[d] = db;
  return true;
}

void SurfaceEditor::begin_stage() {
  stage_begin_ = surface_.triangle_count();
  ancestors_.clear();
}

Index SurfaceEditor::append_submesh(Index mesh, const std::string& name, Index material) {
  make_room_for_additions(mesh);
  auto& submeshes = character_.meshes[mesh].submeshes;
  submeshes.push_back({name, material});
  additions_.push_back({Addition::Kind::submesh, mesh});
  return static_cast<Index>(submeshes.size() - 1);
}

Index SurfaceEditor::append_rim_vertex(Index mesh, const VertexRef& like) {
  Mesh& of = character_.meshes[mesh];
  const Mesh& of_like = character_.meshes[like.mesh];
  const Index attributes_of = like.mesh == mesh ? like.vertex : 0;
  make_room_for_vertices(mesh, 1, static_cast<Index>(of_like.weights.of(like.vertex).size() + of.weights.of(attributes_of).size()));
  births_[mesh].push_back({kNone, {1, 0, 0}});
  records_[mesh].push_back(record_of(like.mesh, like.vertex));
  vertex_mesh_.push_back(mesh);
  const Index vertex = append_vertex_copy(attributes_of, of);
  if (like.mesh != mesh) copy_surface_point(of_like, like.vertex, vertex, of);
  return vertex;
}

Index SurfaceEditor::append_filling_vertex(Index mesh, Index like) {
  Mesh& of = character_.meshes[mesh];
  const std::size_t influences = born_influences(mesh, like).size() + of.weights.of(like).size();
  make_room_for_vertices(mesh, 1, static_cast<Index>(influences));
  births_[mesh].push_back({kNone, {1, 0, 0}});
  records_[mesh].push_back({{mesh, of.vertex_count()}});
  vertex_mesh_.push_back(mesh);
  const Index vertex = append_vertex_copy(like, of);
  if (born_at(mesh, like) != kNone) set_position_and_influences(born_position(mesh, like), born_influences(mesh, like), vertex, of);
  return vertex;
}

Index SurfaceEditor::append_filling(Index mesh, Index submesh, const std::array<Index, 3>& points, const Triangle& vertices) {
  make_room_for_triangles(mesh, 1);
  make_room_for_additions(mesh);
  const Index origin = source_.meshes[mesh].triangle_count() + static_cast<Index>(fillings_[mesh].size());
  fillings_[mesh].push_back(vertices);
  additions_.push_back({Addition::Kind::filling, mesh});
  filling_serials_[mesh].push_back(next_serial_++);
  const Index triangle = surface_.triangle_count();
  Mesh& of = character_.meshes[mesh];
  surface_.appended.push_back({mesh, of.triangle_count(), origin});
  newest_entry_.push_back(kNone);
  parents_.push_back(kNone);
  chain_new_parts();
  appended_triangles_[mesh].push_back(triangle);
  ancestors_.push_back(triangle);
  of.triangles.push_back(vertices);
  of.triangle_submesh.push_back(submesh);
  for (Index k = 0; k < 3; ++k) {
    surface_.corner_point.push_back(points[k]);
    surface_.twin.push_back(kNone);
    write_side(mesh, vertices[k], surface_.side(points[k]));
    if (surface_.point_corner[points[k]] == kNone) surface_.point_corner[points[k]] = 3 * triangle + k;
    Birth& birth = births_[mesh][vertices[k] - source_.meshes[mesh].vertex_count()];
    if (birth.triangle != kNone) continue;
    birth = {origin, {0, 0, 0}};
    birth.barycentric[k] = 1;
  }
  return triangle;
}

void SurfaceEditor::connect(Index a, Index b) {
  make_room_in_log(2);
  log_triangle(a / 3);
  log_triangle(b / 3);
  join(a, b);
}

SurfaceEditor::Mark SurfaceEditor::mark() {
  logged_since_ = {surface_.point_count(),
                   surface_.triangle_count(),
                   static_cast<Index>(vertex_mesh_.size()),
                   static_cast<Index>(additions_.size()),
                   static_cast<Index>(born_.size()),
                   next_side_,
                   static_cast<Index>(log_.size()),
                   static_cast<Index>(side_log_.size())};
  return logged_since_;
}

std::span<const SurfaceEditor::MeshSizes> SurfaceEditor::sizes_at(const Mark& mark) const {
  sizes_.clear();
  for (const Mesh& mesh : character_.meshes) sizes_.push_back({mesh.vertex_count(), mesh.triangle_count()});
  if (sizes_.size() == 1) {
    sizes_[0].vertices -= vertices_since(mark);
    sizes_[0].triangles -= surface_.triangle_count() - mark.triangles;
    return sizes_;
  }
  for (Index i = mark.vertices; i < vertex_mesh_.size(); ++i) --sizes_[vertex_mesh_[i]].vertices;
  for (Index t = mark.triangles; t < surface_.triangle_count(); ++t) --sizes_[surface_.triangle(t).mesh].triangles;
  return sizes_;
}

void SurfaceEditor::roll_back(const Mark& to) {
  for (; log_.size() > to.log_length; log_.pop_back()) {
    restore(log_.back());
    newest_entry_[log_.back().triangle] = log_.back().previous;
  }
  for (; side_log_.size() > to.side_log_length; side_log_.pop_back())
    (*tear_sides(side_log_.back().mesh))[side_log_.back().vertex] = side_log_.back().side;
  const std::span<const MeshSizes> sizes = sizes_at(to);
  for (Index m = 0; m < character_.meshes.size(); ++m) {
    Mesh& mesh = character_.meshes[m];
    if (mesh.vertex_count() > sizes[m].vertices) {
      forget_exact(m, sizes[m].vertices);
      remove_vertices_from(sizes[m].vertices, mesh);
    }
    births_[m].resize(sizes[m].vertices - source_.meshes[m].vertex_count());
    records_[m].resize(births_[m].size());
    appended_triangles_[m].resize(sizes[m].triangles - source_.meshes[m].triangle_count());
    mesh.triangles.resize(sizes[m].triangles);
    mesh.triangle_submesh.resize(sizes[m].triangles);
  }
  for (; additions_.size() > to.additions; additions_.pop_back()) {
    const Index m = additions_.back().mesh;
    Mesh& mesh = character_.meshes[m];
    switch (additions_.back().kind) {
      case Addition::Kind::filling:
        fillings_[m].pop_back();
        filling_serials_[m].pop_back();
        break;
      case Addition::Kind::submesh: mesh.submeshes.pop_back(); break;
      case Addition::Kind::tear_sides:
        spare_sides_[m] = std::move(mesh.custom_attributes.back().values);
        mesh.custom_attributes.pop_back();
        side_attribute_[m] = kNone;
        break;
    }
  }
  unchain_parts_from(to.triangles);
  const Index source_triangles = surface_.first_triangle.back();
  surface_.appended.resize(to.triangles - source_triangles);
  parents_.resize(to.triangles - source_triangles);
  newest_entry_.resize(to.triangles);
  surface_.corner_point.resize(3 * std::size_t{to.triangles});
  surface_.twin.resize(3 * std::size_t{to.triangles});
  surface_.appended_side.resize(to.points - surface_.source_point_count());
  surface_.point_corner.resize(to.points);
  vertex_mesh_.resize(to.vertices);
  resize_born(to.born);
  next_side_ = to.next_side;
  logged_since_ = to;
  if (to.triangles >= stage_begin_) {
    ancestors_.resize(to.triangles - stage_begin_);
  } else {
    stage_begin_ = to.triangles;
    ancestors_.clear();
  }
}

std::vector<float>* SurfaceEditor::tear_sides(Index mesh) {
  if (side_attribute_[mesh] == kNone) return nullptr;
  return &character_.meshes[mesh].custom_attributes[side_attribute_[mesh]].values;
}

void SurfaceEditor::add_tear_sides(Index mesh) {
  Mesh& of = character_.meshes[mesh];
  side_attribute_[mesh] = static_cast<Index>(of.custom_attributes.size());
  of.custom_attributes.push_back({kTearSideAttribute, 1, false, std::move(spare_sides_[mesh])});
  of.custom_attributes.back().values.resize(of.vertex_count(), 0.0f);
  additions_.push_back({Addition::Kind::tear_sides, mesh});
}

void SurfaceEditor::write_side(Index mesh, Index vertex, Index side) {
  if (side_attribute_[mesh] == kNone) {
    if (side == 0) return;
    add_tear_sides(mesh);
  }
  float& value = (*tear_sides(mesh))[vertex];
  if (value == static_cast<float>(side)) return;
  side_log_.push_back({mesh, vertex, value});
  value = static_cast<float>(side);
}

void SurfaceEditor::write_side_of_new(Index mesh, Index vertex, Index side) {
  if (side_attribute_[mesh] == kNone) add_tear_sides(mesh);
  (*tear_sides(mesh))[vertex] = static_cast<float>(side);
}

}  // namespace sunder::tear
