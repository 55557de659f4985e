#include "tear/detached/released_vertices.h"

#include <algorithm>

namespace sunder::tear {
namespace {

/// Faces of other pieces may use a vertex of the source that several fans share, so those stay.
void add(Index mesh, const Triangle& triangle, const Surface& surface, VerticesOfMeshes& vertices) {
  const auto& is_shared = surface.is_shared_vertex[mesh];
  for (const Index vertex : triangle)
    if (vertex >= is_shared.size() || !is_shared[vertex]) vertices[mesh].push_back(vertex);
}

void sort_and_unite_each(VerticesOfMeshes& vertices) {
  for (std::vector<Index>& of_mesh : vertices) {
    std::sort(of_mesh.begin(), of_mesh.end());
    of_mesh.erase(std::unique(of_mesh.begin(), of_mesh.end()), of_mesh.end());
  }
}

}  // namespace

VerticesOfMeshes released_vertices(const EditLog::Mark& begin, const SurfaceEditor& editor) {
  VerticesOfMeshes vertices(editor.character().meshes.size());
  editor.log.for_each_first_change(begin, [&](const TriangleChange& before) {
    add(editor.surface().triangle(before.triangle).mesh, before.vertices, editor.surface(),
        vertices);
  });
  sort_and_unite_each(vertices);
  return vertices;
}

VerticesOfMeshes released_vertices(const SurfaceEditor::Redo& redo, const SurfaceEditor& editor) {
  VerticesOfMeshes vertices(editor.character().meshes.size());
  for (const TriangleChange& changed : redo.changed)
    add(editor.surface().triangle(changed.triangle).mesh,
        editor.connectivity.vertices_of(changed.triangle), editor.surface(), vertices);
  sort_and_unite_each(vertices);
  return vertices;
}

void put_released(VerticesOfMeshes& vertices, ChangeRecord& change) noexcept {
  for (MeshChange& of_mesh : change.meshes) of_mesh.released.swap(vertices[of_mesh.mesh]);
}

void put_returned(VerticesOfMeshes& vertices, ChangeRecord& change) noexcept {
  for (MeshChange& of_mesh : change.meshes) of_mesh.returned.swap(vertices[of_mesh.mesh]);
}

}  // namespace sunder::tear
