#include "bench/harness/subdivided_model.h"

#include <cstdio>
#include <fstream>
#include <map>
#include <string>

#include "support/models/rigs.h"

namespace sunder::bench {
namespace {

/// Reads an OFF file of triangles. @return whether the file exists.
bool read_off(const std::string& file, Mesh& mesh) {
  std::ifstream stream(file);
  std::string word;
  std::size_t vertices = 0, faces = 0, edges = 0;
  if (!(stream >> word >> vertices >> faces >> edges) || word != "OFF") return false;
  mesh.positions.resize(vertices);
  for (Vec3f& position : mesh.positions) stream >> position.x() >> position.y() >> position.z();
  mesh.triangles.resize(faces);
  for (Triangle& triangle : mesh.triangles) {
    std::size_t corners = 0;
    stream >> corners >> triangle[0] >> triangle[1] >> triangle[2];
    if (corners != 3) return false;
  }
  return static_cast<bool>(stream);
}

Character make_base() {
  const std::string file = SUNDER_SHARED_MODELS "/static/bunny_3485.off";
  Character bunny;
  bunny.name = "bunny";
  if (Mesh mesh; read_off(file, mesh)) {
    mesh.name = "bunny";
    mesh.submeshes.push_back({"fur", kNone});
    bunny.meshes.push_back(std::move(mesh));
    return bunny;
  }
  std::fprintf(stderr, "%s is not there: a procedural ball instead\n", file.c_str());
  return test::make_bumpy_ball(3486);
}

/// Indices of the points of subdivided triangles: corners first, then points inside edges, which
/// both faces share, then points inside faces.
class Subdivision {
 public:
  Subdivision(const Mesh& base, int divisions, Mesh& mesh)
      : base_(base), divisions_(divisions), mesh_(mesh) {
    mesh_.positions = base.positions;
  }

  void add(const Triangle& triangle) {
    const int n = divisions_;
    std::vector<std::uint32_t> row_before, row;
    for (int i = 0; i <= n; ++i) {  // from the first corner to the opposite side
      row.clear();
      for (int j = 0; j <= i; ++j) row.push_back(point(triangle, n - i, i - j, j));
      for (int j = 0; i > 0 && j < i; ++j) {
        mesh_.triangles.push_back({row_before[j], row[j], row[j + 1]});
        if (j + 1 < i) mesh_.triangles.push_back({row_before[j], row[j + 1], row_before[j + 1]});
      }
      row_before = row;
    }
  }

 private:
  /// The point of a triangle with barycentric coordinates parts / divisions.
  std::uint32_t point(const Triangle& t, int a, int b, int c) {
    if (a == divisions_) return t[0];
    if (b == divisions_) return t[1];
    if (c == divisions_) return t[2];
    if (a == 0) return on_edge(t[1], t[2], c);
    if (b == 0) return on_edge(t[2], t[0], a);
    if (c == 0) return on_edge(t[0], t[1], b);
    return append((a * place(t[0]) + b * place(t[1]) + c * place(t[2])) / divisions_);
  }

  std::uint32_t on_edge(std::uint32_t from, std::uint32_t to, int part) {
    if (from > to) return on_edge(to, from, divisions_ - part);
    const auto [known, is_new] = first_on_edge_.try_emplace({from, to}, mesh_.vertex_count());
    for (int i = 1; is_new && i < divisions_; ++i)
      append(((divisions_ - i) * place(from) + i * place(to)) / divisions_);
    return known->second + static_cast<std::uint32_t>(part) - 1;
  }

  [[nodiscard]] Vec3d place(std::uint32_t vertex) const {
    return base_.positions[vertex].cast<double>();
  }
  std::uint32_t append(const Vec3d& position) {
    mesh_.positions.push_back(position.cast<float>());
    return mesh_.vertex_count() - 1;
  }

  const Mesh& base_;
  int divisions_;
  Mesh& mesh_;
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> first_on_edge_;
};

/// Unit normals, weighted by area, and texture coordinates projected along z.
void add_normals_and_uvs(Mesh& mesh) {
  std::vector<Vec3d> sums(mesh.vertex_count(), Vec3d::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.positions[t[0]].cast<double>(), b = mesh.positions[t[1]].cast<double>();
    const Vec3d normal = (b - a).cross(mesh.positions[t[2]].cast<double>() - a);
    for (const std::uint32_t vertex : t) sums[vertex] += normal;
  }
  mesh.normals.clear();
  for (const Vec3d& sum : sums) mesh.normals.push_back(Vec3d(sum.normalized()).cast<float>());
  mesh.uv_sets.assign(1, {});
  for (const Vec3f& position : mesh.positions)
    mesh.uv_sets[0].emplace_back(position.x(), position.y());
}

}  // namespace

Character make_subdivided_model(int divisions, std::uint32_t bone_count) {
  Character character = make_base();
  const Mesh base = std::move(character.meshes[0]);
  Mesh& mesh = character.meshes[0] = {};
  mesh.name = base.name;
  mesh.submeshes = base.submeshes;
  Subdivision subdivision(base, divisions, mesh);
  for (const Triangle& triangle : base.triangles) subdivision.add(triangle);
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  add_normals_and_uvs(mesh);
  test::rig_along(character, bone_count);
  return character;
}

}  // namespace sunder::bench
