#include "tear/surface/describe_change.h"

#include <algorithm>
#include <array>

#include "tear/surface/sort_by_index.h"

namespace sunder::tear {
namespace {

void fill_dirty_ranges(std::span<const SideChange> sides, const SurfaceEditor& editor,
                       MeshChange& change) {
  ScratchVector<Index> dirty(&editor.scratch());
  for (const SideChange& side : sides)
    if (side.mesh == change.mesh && side.vertex < change.first_vertex) dirty.push_back(side.vertex);
  std::sort(dirty.begin(), dirty.end());
  for (Index v = 0; v < change.vertex_count; ++v) dirty.push_back(change.first_vertex + v);
  change.dirty_vertices = DirtyRanges::covering(dirty);
  dirty.clear();
  for (const RewrittenTriangle& rewritten : change.rewritten) dirty.push_back(rewritten.triangle);
  for (Index t = 0; t < change.triangle_count; ++t) dirty.push_back(change.first_triangle + t);
  change.dirty_triangles = DirtyRanges::covering(dirty);
}

/// Writes the changes of meshes one after the other into a record.
class RecordWriter {
 public:
  RecordWriter(const SurfaceEditor& editor, ChangeRecord& change)
      : editor_(editor), change_(change) {}
  ~RecordWriter() { change_.meshes.resize(count_); }
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  /// Opens an empty change of a mesh. It becomes part of the record when it is closed.
  MeshChange& open(Index mesh) {
    if (count_ == change_.meshes.size()) change_.meshes.emplace_back();
    MeshChange& opened = change_.meshes[count_];
    opened.mesh = mesh;
    opened.first_vertex = opened.vertex_count = opened.first_triangle = opened.triangle_count = 0;
    opened.births.clear();
    opened.rewritten.clear();
    opened.retired.clear();
    opened.released.clear();
    opened.returned.clear();
    return opened;
  }
  /// @param sides  the values of _TEARSIDE that were written.
  void close(std::span<const SideChange> sides) {
    fill_dirty_ranges(sides, editor_, change_.meshes[count_++]);
  }

 private:
  const SurfaceEditor& editor_;
  ChangeRecord& change_;
  std::size_t count_ = 0;
};

/// Lists the points on edges that an operation welded.
/// @param moved  each corner that got another point: (the point now, the point before).
void list_welded(std::span<const std::array<Index, 2>> scars, std::span<const WeldedPoint> moved,
                 std::vector<WeldedPoint>& welded) {
  welded.assign(moved.begin(), moved.end());
  for (const auto& scar : scars)
    for (const Index point : scar) welded.push_back({point, point});
  std::sort(welded.begin(), welded.end(), [](const WeldedPoint& a, const WeldedPoint& b) {
    return std::array{a.kept, a.lost} < std::array{b.kept, b.lost};
  });
  welded.erase(std::unique(welded.begin(), welded.end()), welded.end());
}

void describe_welded(const EditLog::Mark& begin, const SurfaceEditor& editor,
                     std::vector<WeldedPoint>& welded) {
  welded.clear();
  const auto scars = editor.connectivity.scars().subspan(begin.scars);
  if (scars.empty()) return;
  const Surface& surface = editor.surface();
  ScratchVector<WeldedPoint> moved(&editor.scratch());
  editor.log.for_each_first_change(begin, [&](const TriangleChange& before) {
    for (Index k = 0; k < 3; ++k) {
      const Index was = before.points[k], is = surface.corner_point[3 * before.triangle + k];
      if (was != kNone && is != kNone && surface.point_corner[was] == kNone)
        moved.push_back({is, was});
    }
  });
  list_welded(scars, moved, welded);
}

void describe_welded(const SurfaceEditor::Redo& redo, const SurfaceEditor& editor,
                     std::vector<WeldedPoint>& welded) {
  welded.clear();
  if (redo.tails.edit.scars.empty()) return;
  ScratchVector<Index> lost(&editor.scratch());
  for (const auto& [point, corner] : redo.known_corners)
    if (corner == kNone) lost.push_back(point);
  std::sort(lost.begin(), lost.end());
  ScratchVector<WeldedPoint> moved(&editor.scratch());
  for (const TriangleChange& after : redo.changed)
    for (Index k = 0; k < 3; ++k) {
      const Index was = editor.surface().corner_point[3 * after.triangle + k], is = after.points[k];
      if (is != kNone && std::binary_search(lost.begin(), lost.end(), was))
        moved.push_back({is, was});
    }
  list_welded(redo.tails.edit.scars, moved, welded);
}

void list_retired(std::span<const Triangle> appended, MeshChange& change) {
  for (std::size_t t = 0; t < appended.size(); ++t)
    if (is_retired(appended[t]))
      change.retired.push_back(change.first_triangle + static_cast<Index>(t));
}

}  // namespace

void describe_change(const EditLog::Mark& begin, const SurfaceEditor& editor,
                     ChangeRecord& change) {
  const Surface& surface = editor.surface();
  const auto& meshes = editor.character().meshes;
  change.first_point = begin.points;
  change.point_count = surface.point_count() - begin.points;
  describe_welded(begin, editor, change.welded);

  struct Changed {
    Index triangle;
    const TriangleChange* before;
  };
  ScratchVector<Changed> changed(&editor.scratch());
  ScratchVector<bool> has_changed(meshes.size(), false, &editor.scratch());
  editor.log.for_each_first_change(begin, [&](const TriangleChange& before) {
    const TriangleRef ref = surface.triangle(before.triangle);
    if (is_same(meshes[ref.mesh].triangles[ref.triangle], before.vertices)) return;
    changed.push_back({before.triangle, &before});
    has_changed[ref.mesh] = true;
  });
  // The triangles of each mesh are in order then, too.
  sort_by_index(
      changed, [](const Changed& of) { return of.triangle; }, editor.scratch());
  const std::span<const RowCounts> rows = editor.log.mesh_rows_since(begin);

  RecordWriter writer(editor, change);
  for (Index m = 0; m < meshes.size(); ++m) {
    const Mesh& mesh = meshes[m];
    const Index vertices = rows[m][Rows::mesh_vertices], triangles = rows[m][Rows::mesh_triangles];
    if (!has_changed[m] && vertices == 0 && triangles == 0) continue;
    MeshChange& of_mesh = writer.open(m);
    of_mesh.first_vertex = mesh.vertex_count() - vertices;
    of_mesh.vertex_count = vertices;
    of_mesh.first_triangle = mesh.triangle_count() - triangles;
    of_mesh.triangle_count = triangles;
    for (const Changed& of : changed) {
      const TriangleRef ref = surface.triangle(of.triangle);
      if (ref.mesh != m) continue;
      of_mesh.rewritten.push_back({ref.triangle, of.before->vertices});
      if (is_retired(mesh.triangles[ref.triangle])) of_mesh.retired.push_back(ref.triangle);
    }
    list_retired(std::span(mesh.triangles).last(triangles), of_mesh);
    const std::span<const Birth> births = editor.births.newest(m, vertices);
    of_mesh.births.assign(births.begin(), births.end());
    writer.close(editor.log.side_changes_since(begin));
  }
}

void describe_roll_back(const EditLog::Mark& begin, const SurfaceEditor& editor,
                        ChangeRecord& change) {
  describe_change(begin, editor, change);
  // The same triangles are rewritten back, and everything appended is removed.
  change.point_count = 0;
  change.lips.clear();
  change.rims.left.clear();
  change.rims.right.clear();
  for (MeshChange& of_mesh : change.meshes) {
    of_mesh.vertex_count = of_mesh.triangle_count = 0;
    of_mesh.births.clear();
    of_mesh.retired.clear();
    const std::vector<Triangle>& triangles = editor.character().meshes[of_mesh.mesh].triangles;
    for (RewrittenTriangle& rewritten : of_mesh.rewritten)
      rewritten.before = triangles[rewritten.triangle];
    fill_dirty_ranges(editor.log.side_changes_since(begin), editor, of_mesh);
  }
}

void describe_redo(const SurfaceEditor::Redo& redo, const SurfaceEditor& editor,
                   ChangeRecord& change) {
  const Surface& surface = editor.surface();
  const auto& meshes = editor.character().meshes;
  change.first_point = surface.point_count();
  change.point_count = static_cast<Index>(redo.tails.edit.surface.point_corner.size());
  describe_welded(redo, editor, change.welded);
  RecordWriter writer(editor, change);
  for (Index m = 0; m < meshes.size(); ++m) {
    const std::vector<Birth>& births = redo.tails.edit.meshes[m].births;
    const std::vector<Triangle>& triangles = redo.tails.meshes[m].triangles;
    MeshChange& of_mesh = writer.open(m);
    of_mesh.first_vertex = meshes[m].vertex_count();
    of_mesh.vertex_count = static_cast<Index>(births.size());
    of_mesh.first_triangle = meshes[m].triangle_count();
    of_mesh.triangle_count = static_cast<Index>(triangles.size());
    of_mesh.births = births;
    for (const TriangleChange& changed : redo.changed) {
      const TriangleRef ref = surface.triangle(changed.triangle);
      if (ref.mesh != m || meshes[m].triangles[ref.triangle] == changed.vertices) continue;
      of_mesh.rewritten.push_back({ref.triangle, meshes[m].triangles[ref.triangle]});
      if (is_retired(changed.vertices)) of_mesh.retired.push_back(ref.triangle);
    }
    list_retired(triangles, of_mesh);
    if (of_mesh.rewritten.empty() && births.empty() && triangles.empty()) continue;
    writer.close(redo.sides);
  }
}

}  // namespace sunder::tear
