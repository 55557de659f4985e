#include "tear/surface_editor.h"

#include <algorithm>
#include <cassert>

namespace sunder::tear {
namespace {

/// Smaller parts of a source triangle are not made: rounding of barycentric coordinates could turn them over.
constexpr double kLeastPart = 1e-14;

/// The part of a triangle that lies between three places in it, by their barycentric coordinates.
double covered_part(const std::array<double, 3>& p, const std::array<double, 3>& q, const std::array<double, 3>& r) {
  return (q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1]);
}

}  // namespace

SurfaceEditor::SurfaceEditor(const Character& source, Character& character)
    : source_(source),
      character_(character),
      surface_(build_surface(character)),
      births_(character.meshes.size()),
      fillings_(character.meshes.size()),
      filling_serials_(character.meshes.size()),
      appended_triangles_(character.meshes.size()),
      source_triangle_count_(surface_.triangle_count()),
      newest_part_(character.meshes.size()) {
  Index first = 0;
  for (const Mesh& mesh : source.meshes) {
    first_triangle_.push_back(first);
    first += mesh.triangle_count();
  }
  for (const Index side : surface_.point_side) next_side_ = std::max(next_side_, side + 1);
  begin_stage();
}

Triangle SurfaceEditor::vertices_of(Index triangle) const {
  const TriangleRef& ref = surface_.triangles[triangle];
  return character_.meshes[ref.mesh].triangles[ref.triangle];
}

void SurfaceEditor::log_triangle(Index triangle) {
  LogEntry entry{triangle, {}, {}, {}, vertices_of(triangle)};
  for (Index k = 0; k < 3; ++k) {
    entry.points[k] = surface_.corner_point[3 * triangle + k];
    entry.twins[k] = surface_.twin[3 * triangle + k];
    entry.point_corners[k] = entry.points[k] == kNone ? kNone : surface_.point_corner[entry.points[k]];
  }
  log_.push_back(entry);
}

void SurfaceEditor::restore(const LogEntry& entry) {
  const TriangleRef& ref = surface_.triangles[entry.triangle];
  character_.meshes[ref.mesh].triangles[ref.triangle] = entry.vertices;
  for (Index k = 0; k < 3; ++k) {
    surface_.corner_point[3 * entry.triangle + k] = entry.points[k];
    surface_.twin[3 * entry.triangle + k] = entry.twins[k];
    if (entry.points[k] != kNone) surface_.point_corner[entry.points[k]] = entry.point_corners[k];
  }
}

void SurfaceEditor::set_corner(Index corner, Index point, Index vertex) {
  surface_.corner_point[corner] = point;
  const TriangleRef& ref = surface_.triangles[corner / 3];
  character_.meshes[ref.mesh].triangles[ref.triangle][corner % 3] = vertex;
  if (point != kNone) write_side(ref.mesh, vertex, surface_.point_side[point]);
}

void SurfaceEditor::join(Index a, Index b) {
  surface_.twin[a] = b;
  if (b != kNone) surface_.twin[b] = a;
}

Index SurfaceEditor::append_triangle(Index like, const std::array<Index, 3>& points, const Triangle& vertices) {
  const TriangleRef ref = surface_.triangles[like];
  Mesh& mesh = character_.meshes[ref.mesh];
  const Index triangle = surface_.triangle_count();
  surface_.triangles.push_back({ref.mesh, mesh.triangle_count(), ref.source_triangle});
  chain_new_parts();
  appended_triangles_[ref.mesh].push_back(triangle);
  ancestors_.push_back(ancestor(like));
  const Index submesh = mesh.triangle_submesh[ref.triangle];
  mesh.triangles.push_back(vertices);
  mesh.triangle_submesh.push_back(submesh);
  for (Index k = 0; k < 3; ++k) {
    surface_.corner_point.push_back(points[k]);
    surface_.twin.push_back(kNone);
    write_side(ref.mesh, vertices[k], surface_.point_side[points[k]]);
  }
  return triangle;
}

void SurfaceEditor::chain_new_parts() {
  for (Index t = source_triangle_count_ + static_cast<Index>(older_part_.size()); t < surface_.triangle_count(); ++t) {
    const TriangleRef& ref = surface_.triangles[t];
    std::vector<Index>& newest = newest_part_[ref.mesh];
    const Index source_count = source_.meshes[ref.mesh].triangle_count();
    if (ref.source_triangle >= newest.size()) newest.resize(std::max(source_count, ref.source_triangle + 1), kNone);
    older_part_.push_back(newest[ref.source_triangle]);
    newest[ref.source_triangle] = t;
  }
}

void SurfaceEditor::unchain_parts_from(Index first) {
  for (; source_triangle_count_ + older_part_.size() > first; older_part_.pop_back()) {
    const TriangleRef& ref = surface_.triangles[source_triangle_count_ + older_part_.size() - 1];
    newest_part_[ref.mesh][ref.source_triangle] = older_part_.back();
  }
}

Index SurfaceEditor::append_point() {
  surface_.point_corner.push_back(kNone);
  surface_.point_side.push_back(next_side_++);
  return surface_.point_count() - 1;
}

Index SurfaceEditor::append_vertex(Index mesh, const Birth& birth) {
  births_[mesh].push_back(birth);
  return append_interpolated_vertex(origin_triangle(mesh, birth.triangle), birth.barycentric, character_.meshes[mesh]);
}

void SurfaceEditor::remove_newest_vertex(Index mesh) {
  births_[mesh].pop_back();
  remove_vertices_from(character_.meshes[mesh].vertex_count() - 1, character_.meshes[mesh]);
}

std::array<double, 3> SurfaceEditor::place_in_origin(const TriangleRef& ref, Index vertex) const {
  const Triangle& in_triangle = origin_triangle(ref.mesh, ref.source_triangle);

  std::array<double, 3> result = {0, 0, 0};
  const auto add = [&](Index source_vertex, double part) {
    for (std::size_t k = 0; k < 3; ++k)
      if (in_triangle[k] == source_vertex) {
        result[k] += part;
        return;
      }
    assert(false && "a vertex is shared only by parts of source triangles that share its parents");
  };
  if (vertex < source_.meshes[ref.mesh].vertex_count()) {
    add(vertex, 1.0);
    return result;
  }
  const Birth& born = birth(ref.mesh, vertex);
  if (born.triangle == ref.source_triangle) return born.barycentric;
  for (std::size_t k = 0; k < 3; ++k)
    if (born.barycentric[k] > 0.0) add(origin_triangle(ref.mesh, born.triangle)[k], born.barycentric[k]);
  return result;
}

Birth SurfaceEditor::birth_between(Index triangle, const std::array<double, 3>& barycentric) const {
  Birth birth{surface_.triangles[triangle].source_triangle, {0, 0, 0}};
  double sum = 0;
  for (Index k = 0; k < 3; ++k) {
    if (barycentric[k] <= 0.0) continue;
    const auto corner = source_barycentric(3 * triangle + k);
    for (std::size_t i = 0; i < 3; ++i) {
      birth.barycentric[i] += barycentric[k] * corner[i];
      sum += barycentric[k] * corner[i];
    }
  }
  for (double& coordinate : birth.barycentric) coordinate /= sum;
  return birth;
}

bool SurfaceEditor::keeps_winding(Index corner, Index vertex) const {
  const TriangleRef& ref = surface_.triangles[corner / 3];
  const Mesh& mesh = character_.meshes[ref.mesh];
  const auto normal = [&](const Triangle& of) -> Eigen::Vector3d {
    const Eigen::Vector3d a = mesh.positions[of[0]].cast<double>();
    return (mesh.positions[of[1]].cast<double>() - a).cross(mesh.positions[of[2]].cast<double>() - a);
  };
  const Triangle before = mesh.triangles[ref.triangle];
  Triangle after = before;
  after[corner % 3] = vertex;
  const double part = covered_part(place_in_origin(ref, after[0]), place_in_origin(ref, after[1]), place_in_origin(ref, after[2]));
  if (!(part > kLeastPart)) return false;
  const Eigen::Vector3d normal_before = normal(before);
  const double squared = normal_before.squaredNorm();
  // A face without area has no winding to lose; its parts must only keep their corners apart.
  if (squared == 0.0)
    return mesh.positions[vertex] != mesh.positions[before[(corner + 1) % 3]] &&
           mesh.positions[vertex] != mesh.positions[before[(corner + 2) % 3]];
  if (!(normal(after).dot(normal_before) > 1e-9 * squared)) return false;
  // Normals of slivers are as crooked as stored positions are coarse: parts of parts must not end up facing away.
  const Eigen::Vector3d of_origin = normal(origin_triangle(ref.mesh, ref.source_triangle));
  return of_origin.isZero(0) || normal(after).dot(of_origin) > 0;
}

Index SurfaceEditor::split_edge(Index half_edge, double fraction) {
  // Face f = (a, b, c) lies left of a -> b, face g = (b, a, d) right of it. p goes between a and b:
  // f -> (a, p, c) in place and (p, b, c); g -> (b, p, d) in place and (p, a, d).
  const Index ab = half_edge, bc = Surface::next(ab), ca = Surface::previous(ab);
  const Index ba = surface_.twin[ab];
  const Index f = ab / 3;
  const Index mesh_f = surface_.triangles[f].mesh;
  const Triangle before_f = vertices_of(f);
  const Index vertex_a = before_f[ab % 3], vertex_b = before_f[bc % 3], vertex_c = before_f[ca % 3];

  std::array<double, 3> at = {0, 0, 0};
  at[ab % 3] = 1.0 - fraction;
  at[bc % 3] = fraction;
  const Index vertex_f = append_vertex(mesh_f, birth_between(f, at));

  Index vertex_g = vertex_f;
  Index mesh_g = mesh_f;
  Index ad = kNone, db = kNone;
  Triangle before_g{};
  if (ba != kNone) {
    ad = Surface::next(ba);
    db = Surface::previous(ba);
    mesh_g = surface_.triangles[ba / 3].mesh;
    before_g = vertices_of(ba / 3);
    if (mesh_g != mesh_f || before_g[ad % 3] != vertex_a || before_g[ba % 3] != vertex_b) {
      at = {0, 0, 0};
      at[ad % 3] = 1.0 - fraction;
      at[ba % 3] = fraction;
      vertex_g = append_vertex(mesh_g, birth_between(ba / 3, at));
      copy_surface_point(character_.meshes[mesh_f], vertex_f, vertex_g, character_.meshes[mesh_g]);
    }
  }
  const bool is_sound = keeps_winding(ab, vertex_f) && keeps_winding(bc, vertex_f) &&
                        (ba == kNone || (keeps_winding(ba, vertex_g) && keeps_winding(ad, vertex_g)));
  if (!is_sound) {
    if (vertex_g != vertex_f || mesh_g != mesh_f) remove_newest_vertex(mesh_g);
    remove_newest_vertex(mesh_f);
    return kNone;
  }

  const auto& points = surface_.corner_point;
  const Index a = points[ab], b = points[bc], c = points[ca];
  const Index p = append_point();
  const Index twin_bc = surface_.twin[bc];
  log_triangle(f);
  if (twin_bc != kNone) log_triangle(twin_bc / 3);
  const Index new_f = append_triangle(f, {p, b, c}, {vertex_f, vertex_b, vertex_c});
  const Index pb = 3 * new_f, new_bc = pb + 1, cp = pb + 2;
  set_corner(bc, p, vertex_f);
  move_opened(bc, new_bc);
  if (opened_.count(ab) != 0) opened_.insert(pb);
  join(new_bc, twin_bc);
  join(bc, cp);
  surface_.point_corner[p] = pb;
  surface_.point_corner[b] = new_bc;
  surface_.point_corner[c] = ca;
  join(pb, kNone);
  join(ab, kNone);
  if (ba != kNone) {
    const Index d = points[db];
    const Index twin_ad = surface_.twin[ad];
    log_triangle(ba / 3);
    if (twin_ad != kNone) log_triangle(twin_ad / 3);
    const Index new_g = append_triangle(ba / 3, {p, a, d}, {vertex_g, before_g[ad % 3], before_g[db % 3]});
    const Index pa = 3 * new_g, new_ad = pa + 1, dp = pa + 2;
    set_corner(ad, p, vertex_g);
    move_opened(ad, new_ad);
    join(new_ad, twin_ad);
    join(ad, dp);
    join(ab, pa);
    join(pb, ba);
    surface_.point_corner[d] = db;
  }
  surface_.point_corner[a] = ab;
  return p;
}

Index SurfaceEditor::split_triangle(Index triangle, const std::array<double, 3>& barycentric) {
  const Index mesh = surface_.triangles[triangle].mesh;
  const Index vertex = append_vertex(mesh, birth_between(triangle, barycentric));
  const Index corner = 3 * triangle;
  if (!keeps_winding(corner, vertex) || !keeps_winding(corner + 1, vertex) || !keeps_winding(corner + 2, vertex)) {
    remove_newest_vertex(mesh);
    return kNone;
  }
  // (a, b, c) -> (a, b, p) in place, (b, c, p), (c, a, p).
  const Triangle before = vertices_of(triangle);
  const Index a = surface_.corner_point[corner], b = surface_.corner_point[corner + 1], c = surface_.corner_point[corner + 2];
  const Index twin_bc = surface_.twin[corner + 1], twin_ca = surface_.twin[corner + 2];
  log_triangle(triangle);
  if (twin_bc != kNone) log_triangle(twin_bc / 3);
  if (twin_ca != kNone) log_triangle(twin_ca / 3);
  const Index p = append_point();
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

void SurfaceEditor::begin_opening() { opened_.clear(); }

std::vector<Index> SurfaceEditor::opened() const {
  std::vector<Index> borders;
  for (const Index h : opened_)
    if (h < surface_.twin.size() && surface_.twin[h] == kNone && surface_.corner_point[h] != kNone) borders.push_back(h);
  std::sort(borders.begin(), borders.end());
  return borders;
}

void SurfaceEditor::move_opened(Index from, Index to) {
  if (opened_.erase(from) > 0) opened_.insert(to);
}

void SurfaceEditor::cut_edge(Index half_edge) {
  const Index twin = surface_.twin[half_edge];
  if (twin == kNone) return;
  opened_.insert({half_edge, twin});
  log_triangle(half_edge / 3);
  log_triangle(twin / 3);
  surface_.twin[half_edge] = kNone;
  surface_.twin[twin] = kNone;
}

Index SurfaceEditor::separate_fan(Index corner, const std::vector<Index>& remaining) {
  const Index old_point = surface_.corner_point[corner];
  struct Duplicate {
    Index mesh, vertex, copy;
  };
  std::vector<Duplicate> duplicates;
  const auto is_used_elsewhere = [&](Index mesh, Index vertex) {
    const auto& is_shared = surface_.is_shared_vertex[mesh];
    if (vertex < is_shared.size() && is_shared[vertex]) return true;
    bool used = false;
    for (const Index other : remaining)
      surface_.for_each_in_fan(other,
                               [&](Index c) { used = used || (surface_.triangles[c / 3].mesh == mesh && vertex_at(c) == vertex); });
    return used;
  };

  std::vector<Index> corners;
  surface_.for_each_in_fan(corner, [&](Index c) { corners.push_back(c); });
  for (const Index c : corners) log_triangle(c / 3);
  const Index point = append_point();
  for (const Index c : corners) {
    const Index mesh = surface_.triangles[c / 3].mesh;
    const Index vertex = vertex_at(c);
    auto known = std::find_if(duplicates.begin(), duplicates.end(),
                              [&](const Duplicate& d) { return d.mesh == mesh && d.vertex == vertex; });
    if (known == duplicates.end()) {
      Index copy = vertex;
      if (is_used_elsewhere(mesh, vertex)) {
        births_[mesh].push_back({surface_.triangles[c / 3].source_triangle, source_barycentric(c)});
        copy = append_vertex_copy(vertex, character_.meshes[mesh]);
      }
      known = duplicates.insert(duplicates.end(), {mesh, vertex, copy});
    }
    set_corner(c, point, known->copy);
  }
  surface_.point_corner[point] = corner;
  if (!remaining.empty()) surface_.point_corner[old_point] = remaining.front();
  return point;
}

void SurfaceEditor::retire_triangle(Index triangle) {
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
  const TriangleRef &ref_f = surface_.triangles[f], &ref_g = surface_.triangles[g];
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
  const Mesh& mesh = character_.meshes[ref_f.mesh];
  const Index vertex_a = vertex_at(ab), vertex_b = vertex_at(bc), vertex_c = vertex_at(ca), vertex_d = vertex_at(db);
  const auto normal = [&](Index p, Index q, Index r) -> Eigen::Vector3d {
    const Eigen::Vector3d at_p = mesh.positions[p].cast<double>();
    return (mesh.positions[q].cast<double>() - at_p).cross(mesh.positions[r].cast<double>() - at_p);
  };
  const Triangle& origin = origin_triangle(ref_f.mesh, ref_f.source_triangle);
  const Eigen::Vector3d before = normal(origin[0], origin[1], origin[2]);
  const double least = 1e-9 * normal(vertex_a, vertex_b, vertex_c).norm() * before.norm();
  if (!(normal(vertex_a, vertex_d, vertex_c).dot(before) > least) || !(normal(vertex_b, vertex_c, vertex_d).dot(before) > least))
    return false;

  const Index twin_bc = surface_.twin[bc], twin_ad = surface_.twin[ad];
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
  auto& submeshes = character_.meshes[mesh].submeshes;
  submeshes.push_back({name, material});
  return static_cast<Index>(submeshes.size() - 1);
}

Index SurfaceEditor::append_filling_vertex(Index mesh, Index like) {
  births_[mesh].push_back({kNone, {1, 0, 0}});
  return append_vertex_copy(like, character_.meshes[mesh]);
}

Index SurfaceEditor::append_filling(Index mesh, Index submesh, const std::array<Index, 3>& points, const Triangle& vertices) {
  const Index origin = source_.meshes[mesh].triangle_count() + static_cast<Index>(fillings_[mesh].size());
  fillings_[mesh].push_back(vertices);
  filling_serials_[mesh].push_back(next_serial_++);
  const Index triangle = surface_.triangle_count();
  Mesh& of = character_.meshes[mesh];
  surface_.triangles.push_back({mesh, of.triangle_count(), origin});
  chain_new_parts();
  appended_triangles_[mesh].push_back(triangle);
  ancestors_.push_back(triangle);
  of.triangles.push_back(vertices);
  of.triangle_submesh.push_back(submesh);
  for (Index k = 0; k < 3; ++k) {
    surface_.corner_point.push_back(points[k]);
    surface_.twin.push_back(kNone);
    write_side(mesh, vertices[k], surface_.point_side[points[k]]);
    if (surface_.point_corner[points[k]] == kNone) surface_.point_corner[points[k]] = 3 * triangle + k;
    Birth& birth = births_[mesh][vertices[k] - source_.meshes[mesh].vertex_count()];
    if (birth.triangle != kNone) continue;
    birth = {origin, {0, 0, 0}};
    birth.barycentric[k] = 1;
  }
  return triangle;
}

void SurfaceEditor::connect(Index a, Index b) {
  log_triangle(a / 3);
  log_triangle(b / 3);
  join(a, b);
}

SurfaceEditor::Mark SurfaceEditor::mark() const {
  Mark mark{surface_.point_count(), surface_.triangle_count(), log_.size(), side_log_.size(), next_side_, {}};
  for (Index m = 0; m < character_.meshes.size(); ++m) {
    const Mesh& mesh = character_.meshes[m];
    mark.meshes.push_back({mesh.vertex_count(), mesh.triangle_count(), static_cast<Index>(mesh.submeshes.size()),
                           static_cast<Index>(mesh.custom_attributes.size()), static_cast<Index>(fillings_[m].size())});
  }
  return mark;
}

void SurfaceEditor::roll_back(const Mark& to) {
  for (; log_.size() > to.log_length; log_.pop_back()) restore(log_.back());
  for (; side_log_.size() > to.side_log_length; side_log_.pop_back())
    tear_sides(side_log_.back().mesh)->values[side_log_.back().vertex] = side_log_.back().side;
  unchain_parts_from(to.triangles);
  surface_.triangles.resize(to.triangles);
  surface_.corner_point.resize(3 * std::size_t{to.triangles});
  surface_.twin.resize(3 * std::size_t{to.triangles});
  surface_.point_corner.resize(to.points);
  surface_.point_side.resize(to.points);
  next_side_ = to.next_side;
  if (to.triangles >= stage_begin_) {
    ancestors_.resize(to.triangles - stage_begin_);
  } else {
    stage_begin_ = to.triangles;
    ancestors_.clear();
  }
  for (Index m = 0; m < character_.meshes.size(); ++m) {
    Mesh& mesh = character_.meshes[m];
    const Mark::MeshSizes& sizes = to.meshes[m];
    remove_vertices_from(sizes.vertices, mesh);
    births_[m].resize(sizes.vertices - source_.meshes[m].vertex_count());
    appended_triangles_[m].resize(sizes.triangles - source_.meshes[m].triangle_count());
    fillings_[m].resize(sizes.fillings);
    filling_serials_[m].resize(sizes.fillings);
    mesh.triangles.resize(sizes.triangles);
    mesh.triangle_submesh.resize(sizes.triangles);
    mesh.submeshes.resize(sizes.submeshes);
    mesh.custom_attributes.resize(sizes.custom_attributes);
  }
}

std::vector<Index> SurfaceEditor::touched_since(const Mark& mark) const {
  std::vector<Index> touched;
  for (std::size_t i = mark.log_length; i < log_.size(); ++i) touched.push_back(log_[i].triangle);
  for (Index t = mark.triangles; t < surface_.triangle_count(); ++t) touched.push_back(t);
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  return touched;
}

CustomAttribute* SurfaceEditor::tear_sides(Index mesh) {
  auto& attributes = character_.meshes[mesh].custom_attributes;
  const auto found = std::find_if(attributes.begin(), attributes.end(), [](const CustomAttribute& candidate) {
    return candidate.name == kTearSideAttribute && candidate.components == 1;
  });
  return found == attributes.end() ? nullptr : &*found;
}

void SurfaceEditor::write_side(Index mesh, Index vertex, Index side) {
  CustomAttribute* sides = tear_sides(mesh);
  if (sides == nullptr) {
    if (side == 0) return;
    Mesh& of = character_.meshes[mesh];
    of.custom_attributes.push_back({kTearSideAttribute, 1, false, std::vector<float>(of.vertex_count(), 0.0f)});
    sides = &of.custom_attributes.back();
  }
  float& value = sides->values[vertex];
  if (value == static_cast<float>(side)) return;
  side_log_.push_back({mesh, vertex, value});
  value = static_cast<float>(side);
}

void SurfaceEditor::describe(const Mark& begin, ChangeRecord& change) const {
  change.first_point = begin.points;
  change.point_count = surface_.point_count() - begin.points;
  change.meshes.clear();

  // The oldest entry of a triangle says what it was; what came after is part of the same change.
  std::vector<std::size_t> entries;
  for (std::size_t i = begin.log_length; i < log_.size(); ++i)
    if (log_[i].triangle < begin.triangles) entries.push_back(i);
  std::stable_sort(entries.begin(), entries.end(), [&](std::size_t a, std::size_t b) {
    const TriangleRef &ref_a = surface_.triangles[log_[a].triangle], &ref_b = surface_.triangles[log_[b].triangle];
    return ref_a.mesh != ref_b.mesh ? ref_a.mesh < ref_b.mesh : ref_a.triangle < ref_b.triangle;
  });
  for (Index m = 0; m < character_.meshes.size(); ++m) {
    const Mesh& mesh = character_.meshes[m];
    const Mark::MeshSizes& sizes = begin.meshes[m];
    MeshChange of_mesh;
    of_mesh.mesh = m;
    of_mesh.first_vertex = sizes.vertices;
    of_mesh.vertex_count = mesh.vertex_count() - sizes.vertices;
    of_mesh.first_triangle = sizes.triangles;
    of_mesh.triangle_count = mesh.triangle_count() - sizes.triangles;
    Index previous = kNone;
    for (const std::size_t i : entries) {
      const TriangleRef& ref = surface_.triangles[log_[i].triangle];
      if (ref.mesh != m || log_[i].triangle == previous) continue;
      previous = log_[i].triangle;
      if (mesh.triangles[ref.triangle] == log_[i].vertices) continue;
      of_mesh.rewritten.push_back({ref.triangle, log_[i].vertices});
      if (is_retired(mesh.triangles[ref.triangle])) of_mesh.retired.push_back(ref.triangle);
    }
    if (of_mesh.vertex_count == 0 && of_mesh.triangle_count == 0 && of_mesh.rewritten.empty()) continue;
    for (Index t = of_mesh.first_triangle; t < mesh.triangle_count(); ++t)
      if (is_retired(mesh.triangles[t])) of_mesh.retired.push_back(t);
    const auto source_vertices = static_cast<std::ptrdiff_t>(source_.meshes[m].vertex_count());
    of_mesh.births.assign(births_[m].begin() + (static_cast<std::ptrdiff_t>(sizes.vertices) - source_vertices), births_[m].end());
    change.meshes.push_back(std::move(of_mesh));
  }

  const std::span<const SideEntry> sides = std::span<const SideEntry>(side_log_).subspan(begin.side_log_length);
  for (MeshChange& of_mesh : change.meshes) fill_dirty_ranges(sides, of_mesh);
}

void SurfaceEditor::fill_dirty_ranges(std::span<const SideEntry> sides, MeshChange& change) {
  std::vector<Index> dirty;
  for (const SideEntry& entry : sides)
    if (entry.mesh == change.mesh && entry.vertex < change.first_vertex) dirty.push_back(entry.vertex);
  std::sort(dirty.begin(), dirty.end());
  for (Index v = change.first_vertex; v < change.first_vertex + change.vertex_count; ++v) dirty.push_back(v);
  change.dirty_vertices = DirtyRanges::covering(dirty);
  dirty.clear();
  for (const RewrittenTriangle& rewritten : change.rewritten) dirty.push_back(rewritten.triangle);
  for (Index t = change.first_triangle; t < change.first_triangle + change.triangle_count; ++t) dirty.push_back(t);
  change.dirty_triangles = DirtyRanges::covering(dirty);
}

}  // namespace sunder::tear
