#include "pipeline/validation/match/bind_surface.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"

namespace sunder::validation {
namespace {

/// FNV-1a.
std::uint64_t hash(std::string_view text, std::uint64_t h) {
  for (const char letter : text) h = (h ^ static_cast<unsigned char>(letter)) * 0x100000001B3u;
  return (h ^ 0xFFu) * 0x100000001B3u;
}

/// Normalised, so that weights that do not sum to one do not move a vertex.
Vec3d model_position(const Mesh& mesh, Index vertex, const std::vector<Affine3d>& palette) {
  const Vec3d position = mesh.positions[vertex].cast<double>();
  Vec3d sum = Vec3d::Zero();
  double weights = 0;
  for (const Influence& influence : mesh.weights.of(vertex)) {
    const auto weight = static_cast<double>(influence.weight);
    if (!(weight > 0) || !std::isfinite(weight) || influence.slot >= palette.size()) continue;
    sum += weight * transform(palette[influence.slot], position);
    weights += weight;
  }
  return weights > 0 ? Vec3d(sum / weights) : position;
}

void append_mesh(const Mesh& mesh, const std::vector<Affine3d>& palette, BindSurface& surface) {
  const Index first = surface.vertex_count();
  const std::span<const float> sides = tear_sides(mesh);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    surface.positions.push_back(model_position(mesh, v, palette));
    surface.tear_side.push_back(sides.empty() ? 0.0f : sides[v]);
  }
  const std::uint64_t of_mesh = hash(mesh.name, 0xCBF29CE484222325u);
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    surface.triangles.push_back({first + triangle[0], first + triangle[1], first + triangle[2]});
    surface.region.push_back(hash(mesh.submeshes[mesh.triangle_submesh[t]].name, of_mesh));
  }
  surface.first_vertex.push_back(surface.vertex_count());
  surface.first_triangle.push_back(static_cast<Index>(surface.triangles.size()));
}

/// Whether double arithmetic on float coordinates can tell a triangle from one without area.
bool has_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a;
  const double longest = std::max({squared_norm(ab), squared_norm(ac), squared_norm(ac - ab)});
  return norm(ab.cross(ac)) > 1e-12 * longest;
}

/// The unit normal of a face, and the angle at each corner.
struct Face {
  Vec3d normal;
  std::array<double, 3> angle;
};

Face face_of(const BindSurface& surface, const Triangle& triangle) {
  std::array<Vec3d, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) corner[k] = surface.positions[triangle[k]];
  Face face{(corner[1] - corner[0]).cross(corner[2] - corner[0]), {}};
  face.normal = normalized(face.normal);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d a = corner[(k + 1) % 3] - corner[k], b = corner[(k + 2) % 3] - corner[k];
    face.angle[k] = std::atan2(norm(a.cross(b)), dot(a, b));
  }
  return face;
}

void compute_normals(BindSurface& surface) {
  std::vector<Vec3d> of_point(surface.weld.point_count, Vec3d::Zero());
  std::vector<double> angles(surface.weld.point_count, 0.0);
  surface.normals.assign(surface.positions.size(), Vec3d::Zero());
  for (Index t = 0; t < surface.triangles.size(); ++t) {
    if (!surface.has_area[t]) continue;
    const Face face = face_of(surface, surface.triangles[t]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Index vertex = surface.triangles[t][k], point = surface.weld.point_of_vertex[vertex];
      const Vec3d part = face.angle[k] * face.normal;
      surface.normals[vertex] += part;
      of_point[point] += part;
      angles[point] += face.angle[k];
    }
  }
  constexpr double kCancelled = 0.05;  // of the sum that agreeing faces would have
  for (Index v = 0; v < surface.positions.size(); ++v) {
    const Index point = surface.weld.point_of_vertex[v];
    const bool cancels = norm(of_point[point]) <= kCancelled * angles[point];
    surface.normals[v] = normalized(cancels ? surface.normals[v] : of_point[point]);
  }
}

Index part_of(const std::vector<Index>& first, Index index) {
  return static_cast<Index>(std::upper_bound(first.begin(), first.end(), index) - first.begin() -
                            1);
}

}  // namespace

Index BindSurface::mesh_of_vertex(Index vertex) const { return part_of(first_vertex, vertex); }
Index BindSurface::mesh_of_triangle(Index triangle) const {
  return part_of(first_triangle, triangle);
}

std::vector<std::vector<Affine3d>> bind_palettes(const Character& character,
                                                 const ModelPose& bind) {
  std::vector<std::vector<Affine3d>> palettes;
  for (const Skin& skin : character.skins) {
    auto& palette = palettes.emplace_back();
    for (std::size_t slot = 0; slot < skin.bones.size(); ++slot)
      palette.push_back(multiply(bind.model_from_bone[skin.bones[slot]],
                                 Affine3d(skin.bone_from_bind[slot].cast<double>())));
  }
  return palettes;
}

BindSurface make_bind_surface(const Character& character) {
  return make_bind_surface(character, or_throw(bind_pose(character)));
}

BindSurface make_bind_surface(const Character& character, const ModelPose& pose) {
  const auto palettes = bind_palettes(character, pose);
  BindSurface surface;
  std::size_t vertices = 0, triangles = 0;
  for (const Mesh& mesh : character.meshes) {
    vertices += mesh.vertex_count();
    triangles += mesh.triangle_count();
  }
  surface.positions.reserve(vertices);
  surface.tear_side.reserve(vertices);
  surface.triangles.reserve(triangles);
  surface.region.reserve(triangles);
  for (const Mesh& mesh : character.meshes) append_mesh(mesh, palettes[mesh.skin], surface);
  surface.weld = weld_vertices(character, surface.positions);
  surface.triangle_of_vertex.assign(surface.positions.size(), kNone);
  for (Index t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    surface.has_area.push_back(
        has_area(surface.positions[a], surface.positions[b], surface.positions[c]));
    if (!surface.has_area[t]) continue;
    for (const Index vertex : surface.triangles[t])
      surface.triangle_of_vertex[vertex] = std::min(surface.triangle_of_vertex[vertex], t);
  }
  compute_normals(surface);
  Eigen::AlignedBox3d box;
  for (const Vec3d& position : surface.positions) box.extend(Eigen::Vector3d(position));
  surface.diagonal = surface.positions.empty() ? 0.0 : norm(box.diagonal());
  return surface;
}

}  // namespace sunder::validation
