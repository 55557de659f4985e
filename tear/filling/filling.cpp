#include "tear/filling/filling.h"

#include <sunder/skinning/deform.h>

#include <algorithm>
#include <bit>

#include "core/internal/ordered.h"
#include "core/internal/wall_material.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/mesh_vertices.h"
#include "tear/internal/surface.h"
#include "tear/surface/append_filling.h"

namespace sunder::tear {
namespace {

/// Half-edges by the points that they join.
class DirectedEdges {
 public:
  DirectedEdges(std::size_t most, const Surface& surface, ScratchMemory& scratch)
      : surface_(surface), slots_(std::bit_ceil(2 * most + 1), kNone, &scratch) {}

  /// @return false if there is already one from the same point to the same other one.
  bool add(Index half_edge) {
    Index& slot = find(surface_.corner_point[half_edge], end_of(half_edge));
    if (slot != kNone) return false;
    slot = half_edge;
    return true;
  }
  /// kNone if there is none. The reference is where to put it.
  [[nodiscard]] Index& find(Index from, Index to) {
    const std::uint64_t mixed = (std::uint64_t{from} << 32 | to) * 0x9E3779B97F4A7C15u;
    for (std::size_t i = (mixed >> 32) & (slots_.size() - 1);; i = (i + 1) & (slots_.size() - 1))
      if (slots_[i] == kNone ||
          (surface_.corner_point[slots_[i]] == from && end_of(slots_[i]) == to))
        return slots_[i];
  }

 private:
  [[nodiscard]] Index end_of(Index half_edge) const {
    return surface_.corner_point[Surface::next(half_edge)];
  }

  const Surface& surface_;
  ScratchVector<Index> slots_;
};

/// The attributes that no bone moves.
void set_flat_attributes(Index vertex, const Vec2d& uv, Mesh& mesh) {
  for (auto& uvs : mesh.uv_sets) uvs[vertex] = uv.cast<float>();
  for (auto& colors : mesh.color_sets) colors[vertex] = Vec4f::Ones();
  for (MorphTarget& target : mesh.morph_targets) {
    if (!target.normal_deltas.empty()) target.normal_deltas[vertex].setZero();
    if (!target.tangent_deltas.empty()) target.tangent_deltas[vertex].setZero();
  }
}

}  // namespace

Filling::Filling(const char* name, const Workpiece& work, Index material)
    : name_(name),
      material_(material),
      work_(work),
      submeshes_(&work.editor.scratch()),
      normal_matrices_(&work.editor.scratch()),
      blend_{kNone, ScratchVector<Influence>(&work.editor.scratch()), {}, {}} {
  submeshes_.reserve(work.editor.character().meshes.size());
}

BindFromPosed::BindFromPosed(const Mat3d& posed_from_bind) : inverse_(Mat3d::Zero()) {
  const double size = norm(posed_from_bind);
  is_regular_ = std::abs(determinant(posed_from_bind)) > kNoInverseDeterminant * size * size * size;
  if (is_regular_) inverse_ = inverse(posed_from_bind);
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

Filling::Blend& Filling::blend_of(Index mesh, Index vertex) {
  const Index skin = work_.editor.character().meshes[mesh].skin;
  const std::span<const Influence> influences = work_.editor.births.influences(mesh, vertex);
  if (blend_.skin == skin && std::ranges::equal(blend_.influences, influences)) return blend_;
  blend_.skin = skin;
  blend_.influences.assign(influences.begin(), influences.end());
  blend_.of_places.reset();
  blend_.of_normals.reset();
  return blend_;
}

const BindFromPosed& Filling::bind_from_posed(Index mesh, Index vertex) {
  Blend& blend = blend_of(mesh, vertex);
  if (blend.of_places) return *blend.of_places;
  Mat3d linear = Mat3d::Zero();
  for (const Influence& influence : blend.influences)
    linear += static_cast<double>(influence.weight) *
              work_.posed.pose().palette(blend.skin)[influence.slot].linear();
  return blend.of_places.emplace(linear);
}

const BindFromPosed& Filling::bind_from_posed_normals(Index mesh, Index vertex) {
  Blend& blend = blend_of(mesh, vertex);
  if (blend.of_normals) return *blend.of_normals;
  Mat3d linear = Mat3d::Zero();
  for (const Influence& influence : blend.influences)
    linear += static_cast<double>(influence.weight) * normal_matrix(blend.skin, influence.slot);
  return blend.of_normals.emplace(linear);
}

const Mat3d& Filling::normal_matrix(Index skin, Index slot) {
  const auto& palette = work_.posed.pose().palette(skin);
  if (skin != skin_) {
    skin_ = skin;
    normal_matrices_.assign(palette.size(), {});
  }
  NormalMatrix& matrix = normal_matrices_[slot];
  if (!matrix.is_known) matrix = {compute_normal_matrix(palette[slot].linear()), true};
  return matrix.linear;
}

void Filling::shade(Index mesh, Index vertex, const Vec3d& normal, const Vec3d& tangent,
                    const Vec2d& uv) {
  Mesh& of = work_.editor.mutable_mesh(mesh);
  Vec3d bind_normal = bind_from_posed_normals(mesh, vertex).apply(normal, normal);
  bind_normal =
      norm(bind_normal) > kShortestDirection ? Vec3d(bind_normal / norm(bind_normal)) : normal;
  if (!of.normals.empty()) of.normals[vertex] = bind_normal.cast<float>();
  if (!of.tangents.empty()) {
    Vec3d bind_tangent = to_bind(mesh, vertex, tangent);
    bind_tangent -= dot(bind_normal, bind_tangent) * bind_normal;
    if (!(norm(bind_tangent) > kDirectionLengths * norm(tangent)))
      bind_tangent = bind_normal.unitOrthogonal();
    bind_tangent /= norm(bind_tangent);
    const Vec3f unit = bind_tangent.cast<float>();
    of.tangents[vertex] = {unit.x(), unit.y(), unit.z(), 1.0f};
  }
  set_flat_attributes(vertex, uv, of);
}

void Filling::shade_from_behind(Index mesh, Index vertex, Index other, const Vec2d& uv) {
  Mesh& of = work_.editor.mutable_mesh(mesh);
  if (!of.normals.empty()) of.normals[vertex] = -of.normals[other];
  if (!of.tangents.empty()) of.tangents[vertex] = of.tangents[other];
  set_flat_attributes(vertex, uv, of);
}

Filling::Material Filling::material_at(Index rim_corner) const {
  if (material_ != kNone) return {material_, false};
  const TriangleRef ref = work_.editor.surface().triangle(rim_corner / 3);
  const Mesh& of = work_.editor.character().meshes[ref.mesh];
  const Index of_rim = of.submeshes[of.triangle_submesh[ref.triangle]].material;
  const CustomAttribute* const authored = find_wall_materials(of);
  if (authored == nullptr) return {of_rim, false};
  const Index at_vertex = wall_material_of(authored->values[work_.editor.vertex_at(rim_corner)]);
  return {at_vertex != kNone ? at_vertex : of_rim, true};
}

void Filling::add_triangle(Index mesh, Index like_corner, const std::array<Index, 3>& points,
                           const Triangle& vertices) {
  SurfaceEditor& editor = work_.editor;
  const Material wanted = material_at(like_corner);
  const Mesh& to = editor.character().meshes[mesh];
  auto known =
      std::find_if(submeshes_.begin(), submeshes_.end(), [&](const FillingSubmesh& submesh) {
        return submesh.mesh == mesh &&
               (!wanted.is_authored || to.submeshes[submesh.submesh].material == wanted.index);
      });
  if (known == submeshes_.end()) {
    submeshes_.push_back({mesh, submesh_of_fillings(mesh, name_, wanted.index, editor),
                          editor.fillings.group_count(mesh)});
    known = submeshes_.end() - 1;
  }
  append_filling(*known, points, vertices, editor);
}

void Filling::take_back(const EditLog::Mark& before) {
  work_.editor.roll_back(before);
  work_.posed.forget_from(before.points);
  std::erase_if(submeshes_, [&](const FillingSubmesh& of) {
    return of.group >= work_.editor.fillings.group_count(of.mesh);
  });
}

bool Filling::connect(std::span<const Index> rim_half_edges, const EditLog::Mark& before) {
  const Surface& surface = work_.editor.surface();
  const Index first = 3 * before.triangles, end = 3 * surface.triangle_count();
  const ScratchMemory::Frame frame(work_.editor.scratch());
  DirectedEdges edges(rim_half_edges.size() + end - first, surface, work_.editor.scratch());
  bool is_sound = true;
  for (const Index h : rim_half_edges) is_sound &= edges.add(h);
  const auto is_joined_elsewhere = [&](Index from, Index to) {
    const Index h = surface.find_half_edge(from, to);  // Finds older half-edges only.
    return h != kNone && edges.find(from, to) != h;
  };
  for (Index h = first; h < end; ++h) {
    const Index from = surface.corner_point[h], to = surface.corner_point[Surface::next(h)];
    // An edge between two added triangles is looked up for the first of them.
    if (from < before.points && to < before.points) {
      const Index twin = edges.find(to, from);
      if (twin == kNone || twin < first)
        is_sound &= !is_joined_elsewhere(from, to) && !is_joined_elsewhere(to, from);
    }
    is_sound &= edges.add(h);
  }
  if (!is_sound) return false;
  const auto connect_from = [&](Index h) {
    const Index from = surface.corner_point[h], to = surface.corner_point[Surface::next(h)];
    const Index twin = from < to ? edges.find(to, from) : kNone;
    if (twin != kNone) tear::connect(h, twin, work_.editor);
  };
  for (const Index h : rim_half_edges) connect_from(h);
  for (Index h = first; h < end; ++h) connect_from(h);
  return true;
}

}  // namespace sunder::tear
