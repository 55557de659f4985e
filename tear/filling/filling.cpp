#include "tear/filling/filling.h"

#include <sunder/skinning/deform.h>

#include <algorithm>
#include <unordered_set>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/surface/append_filling.h"
#include "tear/surface/mesh_vertices.h"

namespace sunder::tear {

Vec3d to_bind(const Mat3d& posed_from_bind, const Vec3d& posed, const Vec3d& fallback) {
  const double size = norm(posed_from_bind);
  if (!(std::abs(determinant(posed_from_bind)) > kNoInverseDeterminant * size * size * size))
    return fallback;
  return multiply(inverse(posed_from_bind), posed);
}

Index Filling::add_rim_vertex(Index mesh, Index corner) {
  SurfaceEditor& editor = work_.editor;
  const Index rim_mesh = editor.surface().triangle(corner / 3).mesh,
              rim_vertex = editor.vertex_at(corner);
  return editor.births.append_rim_vertex(mesh, {rim_mesh, rim_vertex});
}

Index Filling::add_inner_vertex(Index mesh, Index like, const Inner& inner) {
  const Index vertex = work_.editor.births.append_filling_vertex(mesh, like);
  Mesh& of = work_.editor.mutable_mesh(mesh);
  set_position_and_influences(inner.bind_position.cast<float>(), inner.influences, vertex, of);
  for (std::size_t i = 0; i < of.morph_targets.size(); ++i)
    if (!of.morph_targets[i].position_deltas.empty())
      of.morph_targets[i].position_deltas[vertex] = inner.morph_displacements[i].cast<float>();
  return vertex;
}

Mat3d Filling::blended(Index mesh, Index vertex) const {
  const Mesh& of = work_.editor.character().meshes[mesh];
  Mat3d linear = Mat3d::Zero();
  for (const Influence& influence : work_.editor.births.influences(mesh, vertex))
    linear += static_cast<double>(influence.weight) *
              work_.posed.pose().palette(of.skin)[influence.slot].linear();
  return linear;
}

void Filling::shade(Index mesh, Index vertex, const Vec3d& normal, const Vec3d& tangent,
                    const Vec2d& uv) {
  Mesh& of = work_.editor.mutable_mesh(mesh);
  const Mat3d posed_from_bind = blended(mesh, vertex);
  Mat3d posed_from_bind_of_normals = Mat3d::Zero();
  for (const Influence& influence : work_.editor.births.influences(mesh, vertex))
    posed_from_bind_of_normals +=
        static_cast<double>(influence.weight) *
        compute_normal_matrix(work_.posed.pose().palette(of.skin)[influence.slot].linear());
  Vec3d bind_normal = to_bind(posed_from_bind_of_normals, normal, normal);
  bind_normal =
      norm(bind_normal) > kShortestDirection ? Vec3d(bind_normal / norm(bind_normal)) : normal;
  Vec3d bind_tangent = to_bind(posed_from_bind, tangent, tangent);
  bind_tangent -= dot(bind_normal, bind_tangent) * bind_normal;
  if (!(norm(bind_tangent) > kDirectionLengths * norm(tangent)))
    bind_tangent = bind_normal.unitOrthogonal();
  bind_tangent /= norm(bind_tangent);
  if (!of.normals.empty()) of.normals[vertex] = bind_normal.cast<float>();
  if (!of.tangents.empty()) {
    const Vec3f unit = bind_tangent.cast<float>();
    of.tangents[vertex] = {unit.x(), unit.y(), unit.z(), 1.0f};
  }
  for (auto& uvs : of.uv_sets) uvs[vertex] = uv.cast<float>();
  for (auto& colors : of.color_sets) colors[vertex] = Vec4f::Ones();
  for (MorphTarget& target : of.morph_targets) {
    if (!target.normal_deltas.empty()) target.normal_deltas[vertex].setZero();
    if (!target.tangent_deltas.empty()) target.tangent_deltas[vertex].setZero();
  }
}

void Filling::add_triangle(Index mesh, Index like_corner, const std::array<Index, 3>& points,
                           const Triangle& vertices) {
  SurfaceEditor& editor = work_.editor;
  auto known = submesh_of_mesh_.find(mesh);
  if (known == submesh_of_mesh_.end()) {
    const TriangleRef ref = editor.surface().triangle(like_corner / 3);
    const Mesh& of = editor.character().meshes[ref.mesh];
    const Index material = of.submeshes[of.triangle_submesh[ref.triangle]].material;
    known = submesh_of_mesh_.emplace(mesh, append_submesh(mesh, name_, material, editor)).first;
  }
  triangles_.push_back(append_filling(mesh, known->second, points, vertices, editor));
}

void Filling::take_back(const EditLog::Mark& before) {
  work_.editor.roll_back(before);
  work_.posed.forget_from(before.points);
  triangles_.clear();
  for (auto at = submesh_of_mesh_.begin(); at != submesh_of_mesh_.end();)
    at = at->second >= work_.editor.character().meshes[at->first].submeshes.size()
             ? submesh_of_mesh_.erase(at)
             : std::next(at);
}

bool Filling::connect(const std::vector<Index>& rim_half_edges) {
  const Surface& surface = work_.editor.surface();
  std::map<std::array<Index, 2>, Index> half_edges;
  std::unordered_set<Index> rim_points;  // lookups only, never iterated
  const auto ends_of = [&](Index h) {
    return std::array{surface.corner_point[h], surface.corner_point[Surface::next(h)]};
  };
  bool is_sound = true;
  const auto add = [&](Index h) { is_sound &= half_edges.emplace(ends_of(h), h).second; };
  for (const Index h : rim_half_edges) {
    add(h);
    rim_points.insert(surface.corner_point[h]);
    rim_points.insert(surface.corner_point[Surface::next(h)]);
  }
  const auto is_joined_elsewhere = [&](Index from, Index to) {
    const Index h = surface.find_half_edge(from, to);  // Finds older half-edges only.
    if (h == kNone) return false;
    const auto known = half_edges.find({from, to});
    return known == half_edges.end() || known->second != h;
  };
  for (const Index triangle : triangles_)
    for (Index h = 3 * triangle; h < 3 * triangle + 3; ++h) {
      const auto [from, to] = ends_of(h);
      if (rim_points.count(from) != 0 && rim_points.count(to) != 0)
        is_sound &= !is_joined_elsewhere(from, to) && !is_joined_elsewhere(to, from);
      add(h);
    }
  triangles_.clear();
  if (!is_sound) return false;
  for (const auto& [points, h] : half_edges) {
    const auto twin = half_edges.find({points[1], points[0]});
    if (twin != half_edges.end() && points[0] < points[1])
      tear::connect(h, twin->second, work_.editor);
  }
  return true;
}

}  // namespace sunder::tear
