// What an operation did, from the editor's logs.

#include <algorithm>

#include "tear/internal/surface.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {

MeshChange& SurfaceEditor::renew_change(std::size_t at, Index mesh, ChangeRecord& change) {
  if (at == change.meshes.size()) change.meshes.emplace_back();
  MeshChange& renewed = change.meshes[at];
  renewed.mesh = mesh;
  renewed.first_vertex = renewed.vertex_count = renewed.first_triangle = renewed.triangle_count = 0;
  renewed.births.clear();
  renewed.rewritten.clear();
  renewed.retired.clear();
  return renewed;
}

void SurfaceEditor::describe(const Mark& begin, ChangeRecord& change) const {
  change.first_point = begin.points;
  change.point_count = surface_.point_count() - begin.points;

  // Of each triangle the oldest entry: what came after is part of the same change.
  ScratchVector<std::uint64_t> changed(&scratch_);  // triangle and entry as one number
  ScratchVector<bool> has_changed(character_.meshes.size(), false, &scratch_);
  for (Index i = begin.log_length; i < log_.size(); ++i) {
    if (!is_oldest_since(begin, i)) continue;
    const TriangleRef ref = surface_.triangle(log_[i].triangle);
    if (is_same(character_.meshes[ref.mesh].triangles[ref.triangle], log_[i].vertices)) continue;
    changed.push_back(std::uint64_t{log_[i].triangle} << 32 | i);
    has_changed[ref.mesh] = true;
  }
  std::sort(changed.begin(), changed.end());  // which orders the triangles of each mesh too
  const std::span<const MeshSizes> sizes = sizes_at(begin);

  std::size_t count = 0;
  for (Index m = 0; m < character_.meshes.size(); ++m) {
    const Mesh& mesh = character_.meshes[m];
    if (!has_changed[m] && mesh.vertex_count() == sizes[m].vertices &&
        mesh.triangle_count() == sizes[m].triangles)
      continue;
    MeshChange& of_mesh = renew_change(count, m, change);
    of_mesh.first_vertex = sizes[m].vertices;
    of_mesh.vertex_count = mesh.vertex_count() - sizes[m].vertices;
    of_mesh.first_triangle = sizes[m].triangles;
    of_mesh.triangle_count = mesh.triangle_count() - sizes[m].triangles;
    for (const std::uint64_t of : changed) {
      const TriangleRef ref = surface_.triangle(static_cast<Index>(of >> 32));
      if (ref.mesh != m) continue;
      of_mesh.rewritten.push_back({ref.triangle, log_[static_cast<Index>(of)].vertices});
      if (is_retired(mesh.triangles[ref.triangle])) of_mesh.retired.push_back(ref.triangle);
    }
    for (Index t = of_mesh.first_triangle; t < mesh.triangle_count(); ++t)
      if (is_retired(mesh.triangles[t])) of_mesh.retired.push_back(t);
    const auto source_vertices = static_cast<std::ptrdiff_t>(source_.meshes[m].vertex_count());
    of_mesh.births.assign(
        births_[m].begin() + (static_cast<std::ptrdiff_t>(sizes[m].vertices) - source_vertices),
        births_[m].end());
    ++count;
  }
  change.meshes.resize(count);

  const std::span<const SideEntry> sides =
      std::span<const SideEntry>(side_log_).subspan(begin.side_log_length);
  for (MeshChange& of_mesh : change.meshes) fill_dirty_ranges(sides, of_mesh);
}

void SurfaceEditor::describe_roll_back(const Mark& begin, ChangeRecord& change) const {
  describe(begin, change);
  // The same triangles are rewritten back; what was appended goes.
  change.point_count = 0;
  change.lips.clear();
  change.rims.left.clear();
  change.rims.right.clear();
  const std::span<const SideEntry> sides =
      std::span<const SideEntry>(side_log_).subspan(begin.side_log_length);
  for (MeshChange& of_mesh : change.meshes) {
    of_mesh.vertex_count = of_mesh.triangle_count = 0;
    of_mesh.births.clear();
    of_mesh.retired.clear();
    const std::vector<Triangle>& triangles = character_.meshes[of_mesh.mesh].triangles;
    for (RewrittenTriangle& rewritten : of_mesh.rewritten)
      rewritten.before = triangles[rewritten.triangle];
    fill_dirty_ranges(sides, of_mesh);
  }
}

void SurfaceEditor::fill_dirty_ranges(std::span<const SideEntry> sides, MeshChange& change) const {
  ScratchVector<Index> dirty(&scratch_);
  for (const SideEntry& entry : sides)
    if (entry.mesh == change.mesh && entry.vertex < change.first_vertex)
      dirty.push_back(entry.vertex);
  std::sort(dirty.begin(), dirty.end());
  for (Index v = change.first_vertex; v < change.first_vertex + change.vertex_count; ++v)
    dirty.push_back(v);
  change.dirty_vertices = DirtyRanges::covering(dirty);
  dirty.clear();
  for (const RewrittenTriangle& rewritten : change.rewritten) dirty.push_back(rewritten.triangle);
  for (Index t = change.first_triangle; t < change.first_triangle + change.triangle_count; ++t)
    dirty.push_back(t);
  change.dirty_triangles = DirtyRanges::covering(dirty);
}

}  // namespace sunder::tear
