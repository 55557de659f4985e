#include "tools/picture/picture.h"

#include <span>
#include <string>
#include <utility>

namespace sunder::tools {
namespace {

/// A rigid mesh.
Mesh make_mesh(const std::string& name) {
  Mesh mesh;
  mesh.name = name;
  mesh.submeshes = {{name, kNone}};
  return mesh;
}

Index append_vertex(Mesh& mesh, const Vec3f& position, const Vec3f& normal) {
  const Influence all_of_root{0, 1.0f};
  mesh.positions.push_back(position);
  mesh.normals.push_back(normal);
  mesh.weights.append({&all_of_root, 1});
  return mesh.vertex_count() - 1;
}

void append_triangle(Mesh& mesh, const Triangle& triangle) {
  mesh.triangles.push_back(triangle);
  mesh.triangle_submesh.push_back(0);
}

/// Renderers shade a surface by its normals and its winding. Where the two disagree, the normals
/// are used.
void wind_by_normals(Mesh& mesh) {
  for (Triangle& triangle : mesh.triangles) {
    const Vec3f& a = mesh.positions[triangle[0]];
    const Vec3f by_winding =
        (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
    const Vec3f by_normals =
        mesh.normals[triangle[0]] + mesh.normals[triangle[1]] + mesh.normals[triangle[2]];
    if (by_winding.dot(by_normals) < 0.0f) std::swap(triangle[1], triangle[2]);
  }
}

/// One posed submesh, with its colours if there are any.
Mesh make_outside(const Mesh& source, const DeformedMesh& posed, Index submesh,
                  std::span<const Vec4f> colors) {
  Mesh mesh = make_mesh(source.submeshes[submesh].name.empty() ? source.name
                                                               : source.submeshes[submesh].name);
  if (!colors.empty()) mesh.color_sets.resize(1);
  std::vector<Index> new_from_old(posed.positions.size(), kNone);
  for (Index t = 0; t < source.triangles.size(); ++t) {
    if (source.triangle_submesh[t] != submesh) continue;
    Triangle triangle = source.triangles[t];
    for (Index& vertex : triangle) {
      Index& copy = new_from_old[vertex];
      if (copy == kNone) {
        copy = append_vertex(mesh, posed.positions[vertex], posed.normals[vertex]);
        if (!colors.empty()) mesh.color_sets[0].push_back(colors[vertex]);
      }
      vertex = copy;
    }
    append_triangle(mesh, triangle);
  }
  return mesh;
}

}  // namespace

Character make_still(const Character& character, const std::vector<DeformedMesh>& posed,
                     const std::vector<std::vector<Vec4f>>& colors) {
  Character still;
  still.name = character.name;
  still.skeleton.bones.push_back({"Still", kNone, {}});
  still.skins.push_back({"Still", {0}, {Affine3f::Identity()}});
  for (Index i = 0; i < posed.size(); ++i)
    for (Index submesh = 0; submesh < character.meshes[i].submeshes.size(); ++submesh)
      still.meshes.push_back(make_outside(
          character.meshes[i], posed[i], submesh,
          i < colors.size() ? std::span<const Vec4f>(colors[i]) : std::span<const Vec4f>()));
  for (Mesh& mesh : still.meshes) wind_by_normals(mesh);
  return still;
}

void paint(Character& still, const Vec4f& color) {
  for (Mesh& mesh : still.meshes)
    if (mesh.color_sets.empty())
      mesh.color_sets.assign(1, std::vector<Vec4f>(mesh.positions.size(), color));
}

}  // namespace sunder::tools
