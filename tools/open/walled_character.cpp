#include "tools/open/walled_character.h"

#include <cstdint>
#include <map>

#include "tear/internal/mesh_vertices.h"
#include "tools/open/bind_displacement.h"

namespace sunder::tools {
namespace {

constexpr const char* kWallName = "Wound";
constexpr const char* kThreadName = "Threads";
constexpr std::size_t kInfluences = 4;  ///< Per vertex, for which room is made.

/// Appends a vertex of a wall to a mesh and to its poses.
void append_wall_vertex(const WoundWalls::Vertex& of, bool has_own_look, const BindSpace& bind,
                        Mesh& mesh, DeformedMesh& closed, DeformedMesh& open) {
  const std::uint32_t vertex = append_vertex_copy(of.like, mesh);
  mesh.positions[vertex] += bind.displacement(of.like, of.closed - closed.positions[of.like]);
  if (!mesh.normals.empty()) mesh.normals[vertex] = bind.normal(of.like, of.normal);
  if (has_own_look) {
    for (auto& uvs : mesh.uv_sets) uvs[vertex] = of.uv;
    for (auto& colors : mesh.color_sets) colors[vertex].setOnes();
  }
  closed.positions.push_back(of.closed);
  open.positions.push_back(of.open);
  for (DeformedMesh* const posed : {&closed, &open}) {
    if (!posed->normals.empty()) posed->normals.push_back(of.normal);
    if (!posed->tangents.empty()) posed->tangents.push_back(Vec4f(posed->tangents[of.like]));
  }
}

/// Appends parts to a torn character and to the opening's meshes.
/// @param name  of their submeshes.
Status add_parts(const WoundWalls& parts, const char* name, const WallMaterial& material_of,
                 Opening& opening, Character& character) {
  for (std::uint32_t m = 0; m < parts.meshes.size(); ++m) {
    const WoundWalls::OfMesh& walls = parts.meshes[m];
    if (walls.triangles.empty()) continue;
    Mesh& mesh = character.meshes[m];
    const std::uint32_t first = mesh.vertex_count();
    if (opening.closed[m].positions.size() != first)
      return Status::failure(StatusCode::size_mismatch, m,
                             "mesh %u: the parts are of %zu vertices, the mesh has %u", m,
                             opening.closed[m].positions.size(), first);
    const Result<BindSpace> bind = BindSpace::create(character, m, opening.pose);
    if (!bind) return bind.error();
    reserve_vertices(walls.vertices.size(), kInfluences * walls.vertices.size(), mesh);
    std::map<std::uint32_t, std::uint32_t> submesh_of;  // Per material.
    for (const WoundWalls::Vertex& vertex : walls.vertices) {
      const std::uint32_t material = material_of(m, vertex.submesh);
      const bool is_lips = material == mesh.submeshes[vertex.submesh].material;
      const auto [entry, is_new] =
          submesh_of.try_emplace(material, static_cast<std::uint32_t>(mesh.submeshes.size()));
      if (is_new) mesh.submeshes.push_back({name, material});
      append_wall_vertex(vertex, !is_lips, *bind, mesh, opening.closed[m], opening.open[m]);
    }
    for (Triangle triangle : walls.triangles) {
      const std::uint32_t submesh = walls.vertices[triangle[0]].submesh;
      for (std::uint32_t& vertex : triangle) vertex += first;
      mesh.triangles.push_back(triangle);
      mesh.triangle_submesh.push_back(submesh_of.at(material_of(m, submesh)));
    }
  }
  return {};
}

}  // namespace

Status add_wound_walls(const WallMaterial& material_of, Opening& opening, Character& character) {
  return add_parts(opening.walls, kWallName, material_of, opening, character);
}

Status add_wound_threads(std::uint32_t material, Opening& opening, Character& character) {
  const WallMaterial of_threads = [material](std::uint32_t, std::uint32_t) { return material; };
  return add_parts(opening.threads, kThreadName, of_threads, opening, character);
}

}  // namespace sunder::tools
