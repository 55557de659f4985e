#include "tear/detached/piece_meshes.h"

#include <algorithm>
#include <memory>

#include "core/internal/index_set.h"
#include "tear/bodies/internal/main_bones.h"

namespace sunder::tear {
namespace {

void sort_and_unite(std::vector<Index>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// The place of a value in an ascending array that holds it.
Index place_in(const std::vector<Index>& values, Index value) {
  return static_cast<Index>(std::lower_bound(values.begin(), values.end(), value) - values.begin());
}

template <class Value>
std::vector<Value> gather(const std::vector<Value>& values, const std::vector<Index>& old_from_new,
                          std::size_t per_element = 1) {
  std::vector<Value> gathered;
  if (values.empty()) return gathered;
  if (per_element == 1) {
    gathered.resize(old_from_new.size());
    for (std::size_t i = 0; i < old_from_new.size(); ++i) gathered[i] = values[old_from_new[i]];
    return gathered;
  }
  gathered.reserve(per_element * old_from_new.size());
  for (const Index old : old_from_new) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(per_element * old);
    gathered.insert(gathered.end(), from, from + static_cast<std::ptrdiff_t>(per_element));
  }
  return gathered;
}

void copy_vertices(const Mesh& from, const std::vector<Index>& vertices, Mesh& to) {
  to.positions = gather(from.positions, vertices);
  to.normals = gather(from.normals, vertices);
  to.tangents = gather(from.tangents, vertices);
  for (const auto& uvs : from.uv_sets) to.uv_sets.push_back(gather(uvs, vertices));
  for (const auto& colors : from.color_sets) to.color_sets.push_back(gather(colors, vertices));
  for (const CustomAttribute& attribute : from.custom_attributes)
    to.custom_attributes.push_back({attribute.name, attribute.components, attribute.interpolates,
                                    gather(attribute.values, vertices, attribute.components)});
  for (const MorphTarget& target : from.morph_targets)
    to.morph_targets.push_back({target.name, gather(target.position_deltas, vertices),
                                gather(target.normal_deltas, vertices),
                                gather(target.tangent_deltas, vertices)});
  std::size_t influences = 0;
  for (const Index vertex : vertices) influences += from.weights.of(vertex).size();
  to.weights.first.reserve(vertices.size() + 1);
  to.weights.influences.reserve(influences);
  for (const Index vertex : vertices) to.weights.append(from.weights.of(vertex));
}

/// Triangles with the new vertices, and the submeshes that they use.
void copy_triangles(const Mesh& from, const std::vector<Index>& triangles,
                    const std::vector<Index>& vertices, Mesh& to) {
  to.triangles = gather(from.triangles, triangles);
  to.triangle_submesh = gather(from.triangle_submesh, triangles);
  // Only entries of the piece are written, so that a small piece of a large mesh costs little.
  const auto new_from_old = std::make_unique_for_overwrite<Index[]>(from.vertex_count());
  for (std::size_t v = 0; v < vertices.size(); ++v)
    new_from_old[vertices[v]] = static_cast<Index>(v);
  for (Triangle& triangle : to.triangles)
    for (Index& vertex : triangle) vertex = new_from_old[vertex];
  std::vector<Index> submeshes(from.submeshes.size(), kNone), used;
  for (const Index submesh : to.triangle_submesh) submeshes[submesh] = 0;
  for (Index submesh = 0; submesh < submeshes.size(); ++submesh) {
    if (submeshes[submesh] == kNone) continue;
    submeshes[submesh] = static_cast<Index>(used.size());
    used.push_back(submesh);
  }
  to.submeshes = gather(from.submeshes, used);
  for (Index& submesh : to.triangle_submesh) submesh = submeshes[submesh];
}

/// Ascending.
std::vector<Index> points_of(const std::vector<DetachedPiece::OfMesh>& maps,
                             const Surface& surface) {
  IndexSet points(surface.point_count());
  for (const DetachedPiece::OfMesh& map : maps)
    for (const auto& corners : map.old_points)
      for (const Index point : corners) points.insert(point);
  return points.list();
}

/// The triangles of a piece, per mesh of the model; the vertices are left out.
std::vector<DetachedPiece::OfMesh> make_triangle_maps(const std::vector<Index>& faces,
                                                      const SurfaceEditor& editor) {
  const auto& meshes = editor.character().meshes;
  std::vector<DetachedPiece::OfMesh> maps(meshes.size());
  for (const Index face : faces) {
    const TriangleRef ref = editor.surface().triangle(face);
    DetachedPiece::OfMesh& map = maps[ref.mesh];
    map.mesh = ref.mesh;
    map.triangle_old_from_new.push_back(ref.triangle);
    const Index* points = &editor.surface().corner_point[3 * face];
    map.old_points.push_back({points[0], points[1], points[2]});
  }
  std::erase_if(maps, [](const auto& map) { return map.triangle_old_from_new.empty(); });
  for (DetachedPiece::OfMesh& map : maps) {
    const Mesh& mesh = meshes[map.mesh];
    const Skin& skin = editor.character().skins[mesh.skin];
    bodies::MainBones main_bones(skin.bones.size());
    map.bones.reserve(map.triangle_old_from_new.size());
    for (const Index triangle : map.triangle_old_from_new)
      map.bones.push_back(main_bones.of(mesh.triangles[triangle], mesh.weights, skin));
  }
  return maps;
}

/// Ascending.
std::vector<Index> vertices_of(const std::vector<Index>& triangles, const Mesh& mesh) {
  IndexSet vertices(mesh.vertex_count());
  for (const Index triangle : triangles)
    for (const Index vertex : mesh.triangles[triangle]) vertices.insert(vertex);
  return vertices.list();
}

}  // namespace

PieceMeshes copy_meshes(const std::vector<Index>& faces, const SurfaceEditor& editor) {
  PieceMeshes piece;
  piece.maps = make_triangle_maps(faces, editor);
  piece.points = points_of(piece.maps, editor.surface());
  for (const DetachedPiece::OfMesh& map : piece.maps)
    piece.skins.push_back(editor.character().meshes[map.mesh].skin);
  sort_and_unite(piece.skins);
  for (DetachedPiece::OfMesh& map : piece.maps) {
    const Mesh& from = editor.character().meshes[map.mesh];
    Mesh& mesh = piece.meshes.emplace_back();
    mesh.name = from.name;
    mesh.skin = place_in(piece.skins, from.skin);
    mesh.first_morph_weight = from.first_morph_weight;
    map.vertex_old_from_new = vertices_of(map.triangle_old_from_new, from);
    copy_vertices(from, map.vertex_old_from_new, mesh);
    copy_triangles(from, map.triangle_old_from_new, map.vertex_old_from_new, mesh);
  }
  return piece;
}

InfluencePositions copy_exact(const InfluencePositions& of, const SkinWeights& weights,
                              const std::vector<Index>& vertex_old_from_new) {
  InfluencePositions copy;
  std::vector<Index> influences;  // entries of the exact vertices that are copied
  Index first = 0;
  auto next = vertex_old_from_new.begin();
  for (const Index vertex : of.vertices) {
    const auto count = static_cast<Index>(weights.of(vertex).size());
    next = std::lower_bound(next, vertex_old_from_new.end(), vertex);
    if (next != vertex_old_from_new.end() && *next == vertex) {
      copy.vertices.push_back(static_cast<Index>(next - vertex_old_from_new.begin()));
      for (Index i = 0; i < count; ++i) influences.push_back(first + i);
    }
    first += count;
  }
  copy.positions = gather(of.positions, influences);
  copy.normals = gather(of.normals, influences);
  copy.tangents = gather(of.tangents, influences);
  for (const InfluencePositions::Deltas& target : of.morph_targets)
    copy.morph_targets.push_back({gather(target.positions, influences),
                                  gather(target.normals, influences),
                                  gather(target.tangents, influences)});
  return copy;
}

Skin reduce_skin(const Skin& skin, Index index, std::vector<Mesh>& meshes) {
  std::vector<Index> new_slot(skin.bones.size(), kNone);
  for (const Mesh& mesh : meshes)
    if (mesh.skin == index)
      for (const Influence& influence : mesh.weights.influences) new_slot[influence.slot] = 0;
  Skin reduced;
  reduced.name = skin.name;
  for (Index slot = 0; slot < new_slot.size(); ++slot) {
    if (new_slot[slot] == kNone) continue;
    new_slot[slot] = static_cast<Index>(reduced.bones.size());
    reduced.bones.push_back(skin.bones[slot]);
    reduced.bone_from_bind.push_back(skin.bone_from_bind[slot]);
  }
  for (Mesh& mesh : meshes)
    if (mesh.skin == index)
      for (Influence& influence : mesh.weights.influences)
        influence.slot = new_slot[influence.slot];
  return reduced;
}

}  // namespace sunder::tear
