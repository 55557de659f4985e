#include "tear/detached/released_vertices.h"

#include "core/internal/index_set.h"

namespace sunder::tear {
namespace {

/// Collects vertices of triangles, per mesh.
class Released {
 public:
  explicit Released(const SurfaceEditor& editor) : surface_(editor.surface()) {
    for (const Mesh& mesh : editor.character().meshes) sets_.emplace_back(mesh.vertex_count());
  }
  /// Faces of other pieces may use a vertex of the source that several fans share, so those stay.
  void add(Index mesh, const Triangle& triangle) {
    const auto& is_shared = surface_.is_shared_vertex[mesh];
    for (const Index vertex : triangle)
      if (vertex >= is_shared.size() || !is_shared[vertex]) sets_[mesh].insert(vertex);
  }
  [[nodiscard]] VerticesOfMeshes list() {
    VerticesOfMeshes vertices;
    for (IndexSet& set : sets_) vertices.push_back(set.list());
    return vertices;
  }

 private:
  const Surface& surface_;
  std::vector<IndexSet> sets_;
};

}  // namespace

VerticesOfMeshes released_vertices(const EditLog::Mark& begin, const SurfaceEditor& editor) {
  Released released(editor);
  editor.log.for_each_first_change(begin, [&](const TriangleChange& before) {
    released.add(editor.surface().triangle(before.triangle).mesh, before.vertices);
  });
  return released.list();
}

VerticesOfMeshes released_vertices(const SurfaceEditor::Redo& redo, const SurfaceEditor& editor) {
  Released released(editor);
  for (const TriangleChange& changed : redo.changed)
    released.add(editor.surface().triangle(changed.triangle).mesh,
                 editor.connectivity.vertices_of(changed.triangle));
  return released.list();
}

void put_released(VerticesOfMeshes& vertices, ChangeRecord& change) noexcept {
  for (MeshChange& of_mesh : change.meshes) of_mesh.released.swap(vertices[of_mesh.mesh]);
}

void put_returned(VerticesOfMeshes& vertices, ChangeRecord& change) noexcept {
  for (MeshChange& of_mesh : change.meshes) of_mesh.returned.swap(vertices[of_mesh.mesh]);
}

}  // namespace sunder::tear
