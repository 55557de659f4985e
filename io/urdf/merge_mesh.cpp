#include "io/urdf/merge_mesh.h"

#include <algorithm>
#include <utility>

namespace sunder::urdf {
namespace {

/// The mean of the normals of the faces at each vertex, by area; any direction where there is none.
std::vector<Vec3f> face_normals(const Mesh& mesh) {
  std::vector<Vec3d> sums(mesh.positions.size(), Vec3d::Zero());
  for (const Triangle& triangle : mesh.triangles) {
    const Vec3d a = mesh.positions[triangle[0]].cast<double>();
    const Vec3d normal = Vec3d(mesh.positions[triangle[1]].cast<double>() - a)
                             .cross(Vec3d(mesh.positions[triangle[2]].cast<double>() - a));
    for (const std::uint32_t corner : triangle) sums[corner] += normal;
  }
  std::vector<Vec3f> normals;
  normals.reserve(sums.size());
  for (const Vec3d& sum : sums)
    normals.push_back(sum.norm() > 0 ? Vec3f(sum.normalized().cast<float>()) : Vec3f(0, 0, 1));
  return normals;
}

/// Makes room for the new vertices in every set; vertices without the set get `absent`.
template <class Vector>
void append_sets(std::vector<std::vector<Vector>>& into,
                 const std::vector<std::vector<Vector>>& sets, std::size_t old_count,
                 std::size_t added, const Vector& absent) {
  if (into.size() < sets.size()) into.resize(sets.size());
  for (std::size_t i = 0; i < into.size(); ++i) {
    into[i].resize(old_count, absent);
    if (i < sets.size()) into[i].insert(into[i].end(), sets[i].begin(), sets[i].end());
    into[i].resize(old_count + added, absent);
  }
}

}  // namespace

void append_mesh(Mesh& into, const Mesh& mesh, const Affine3d& transform) {
  const std::uint32_t first = into.vertex_count();
  const auto first_submesh = static_cast<std::uint32_t>(into.submeshes.size());
  const Mat3d linear = transform.linear();
  const bool mirrors = linear.determinant() < 0;
  const Mat3d of_normals = linear.inverse().transpose();

  const std::vector<Vec3f> own =
      mesh.normals.size() == mesh.positions.size() ? mesh.normals : face_normals(mesh);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    into.positions.push_back((transform * mesh.positions[i].cast<double>()).cast<float>());
    const Vec3d normal = of_normals * own[i].cast<double>();
    into.normals.push_back(normal.norm() > 0 ? Vec3f(normal.normalized().cast<float>())
                                             : Vec3f(0, 0, 1));
  }
  append_sets(into.uv_sets, mesh.uv_sets, first, mesh.positions.size(), Vec2f(0, 0));
  append_sets(into.color_sets, mesh.color_sets, first, mesh.positions.size(), Vec4f(1, 1, 1, 1));
  for (Triangle triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) corner += first;
    if (mirrors) std::swap(triangle[1], triangle[2]);
    into.triangles.push_back(triangle);
  }
  for (const std::uint32_t submesh : mesh.triangle_submesh)
    into.triangle_submesh.push_back(first_submesh + submesh);
  into.submeshes.insert(into.submeshes.end(), mesh.submeshes.begin(), mesh.submeshes.end());
}

}  // namespace sunder::urdf
