#include <algorithm>

#include "tear/internal/surface.h"
#include "tear/surface/mesh_vertices.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {
namespace {

template <class T>
std::vector<T> tail_of(const std::vector<T>& values, std::size_t first) {
  return {values.begin() + static_cast<std::ptrdiff_t>(first), values.end()};
}

template <class T>
void append(std::vector<T>& values, const std::vector<T>& tail) {
  values.insert(values.end(), tail.begin(), tail.end());
}

}  // namespace

void SurfaceEditor::undo(const Mark& begin, Redo& redo, ChangeRecord& change) {
  const std::vector<MeshSizes> sizes(sizes_at(begin).begin(), sizes_at(begin).end());
  redo = {};
  redo.additions = tail_of(additions_, begin.additions);
  for (Index m = 0; m < character_.meshes.size(); ++m) {
    const Mesh& mesh = character_.meshes[m];
    const auto added = [&](Addition::Kind kind) {
      return static_cast<std::size_t>(
          std::count_if(redo.additions.begin(), redo.additions.end(),
                        [&](const Addition& a) { return a.mesh == m && a.kind == kind; }));
    };
    Redo::OfMesh& of_mesh = redo.meshes.emplace_back();
    of_mesh.vertices = copy_vertices_from(sizes[m].vertices, mesh);
    of_mesh.triangles = tail_of(mesh.triangles, sizes[m].triangles);
    of_mesh.triangle_submesh = tail_of(mesh.triangle_submesh, sizes[m].triangles);
    of_mesh.submeshes =
        tail_of(mesh.submeshes, mesh.submeshes.size() - added(Addition::Kind::submesh));
    of_mesh.records = tail_of(records_[m], sizes[m].vertices - source_.meshes[m].vertex_count());
    of_mesh.births = tail_of(births_[m], sizes[m].vertices - source_.meshes[m].vertex_count());
    of_mesh.fillings = tail_of(fillings_[m], fillings_[m].size() - added(Addition::Kind::filling));
    of_mesh.appended_triangles =
        tail_of(appended_triangles_[m], sizes[m].triangles - source_.meshes[m].triangle_count());
  }
  const Index source_triangles = surface_.first_triangle.back();
  redo.corner_point = tail_of(surface_.corner_point, 3 * std::size_t{begin.triangles});
  redo.twin = tail_of(surface_.twin, 3 * std::size_t{begin.triangles});
  redo.triangles = tail_of(surface_.appended, begin.triangles - source_triangles);
  redo.parents = tail_of(parents_, begin.triangles - source_triangles);
  redo.point_corner = tail_of(surface_.point_corner, begin.points);
  redo.side = tail_of(surface_.appended_side, begin.points - surface_.source_point_count());
  redo.vertex_mesh = tail_of(vertex_mesh_, begin.vertices);
  redo.next_side = next_side_;
  redo.born = tail_of(born_, begin.born);
  redo.born_influences =
      tail_of(born_influences_, born_.size() > begin.born ? born_[begin.born].first_influence
                                                          : born_influences_.size());
  redo.log = tail_of(log_, begin.log_length);
  redo.side_log = tail_of(side_log_, begin.side_log_length);
  for (const SideEntry& entry : redo.side_log)
    redo.sides.push_back({entry.mesh, entry.vertex, (*tear_sides(entry.mesh))[entry.vertex]});

  // What the triangles are now, and the corners by which the points that they had or have are
  // known.
  for_each_changed(begin, [&](Index triangle) {
    LogEntry& entry = redo.changed.emplace_back();
    entry.triangle = triangle;
    fill(entry);
  });
  std::sort(redo.changed.begin(), redo.changed.end(),
            [](const LogEntry& a, const LogEntry& b) { return a.triangle < b.triangle; });
  for (const LogEntry& entry : redo.log)
    for (const Index point : entry.points)
      if (point != kNone && point < begin.points)
        redo.known_corners.push_back({point, surface_.point_corner[point]});

  describe_roll_back(begin, change);
  roll_back(begin);
}

void SurfaceEditor::redo(const Redo& redo, ChangeRecord& change) {
  room_ = {};
  change.first_point = surface_.point_count();
  std::size_t count = 0;
  change.point_count = static_cast<Index>(redo.point_corner.size());
  for (const Addition& addition : redo.additions)
    if (addition.kind == Addition::Kind::tear_sides) {
      add_tear_sides(addition.mesh);
      additions_.pop_back();
    }
  append(additions_, redo.additions);
  append(born_, redo.born);
  append(born_influences_, redo.born_influences);
  for (Index m = 0; m < character_.meshes.size(); ++m) {
    Mesh& mesh = character_.meshes[m];
    const Redo::OfMesh& of = redo.meshes[m];
    MeshChange& of_mesh = renew_change(count, m, change);
    of_mesh.first_vertex = mesh.vertex_count();
    of_mesh.vertex_count = static_cast<Index>(of.births.size());
    of_mesh.first_triangle = mesh.triangle_count();
    of_mesh.triangle_count = static_cast<Index>(of.triangles.size());
    of_mesh.births = of.births;
    append_vertices(of.vertices, mesh);
    append(mesh.triangles, of.triangles);
    append(mesh.triangle_submesh, of.triangle_submesh);
    append(mesh.submeshes, of.submeshes);
    append(births_[m], of.births);
    append(records_[m], of.records);
    append(fillings_[m], of.fillings);
    while (filling_serials_[m].size() < fillings_[m].size())
      filling_serials_[m].push_back(next_serial_++);
    append(appended_triangles_[m], of.appended_triangles);
    for (const LogEntry& entry : redo.changed) {
      const TriangleRef ref = surface_.triangle(entry.triangle);
      if (ref.mesh != m || mesh.triangles[ref.triangle] == entry.vertices) continue;
      of_mesh.rewritten.push_back({ref.triangle, mesh.triangles[ref.triangle]});
      if (is_retired(entry.vertices)) of_mesh.retired.push_back(ref.triangle);
    }
    for (Index t = of_mesh.first_triangle; t < mesh.triangle_count(); ++t)
      if (is_retired(mesh.triangles[t])) of_mesh.retired.push_back(t);
    if (of_mesh.rewritten.empty() && of.births.empty() && of.triangles.empty()) continue;
    fill_dirty_ranges(redo.sides, of_mesh);
    ++count;
  }
  change.meshes.resize(count);
  append(surface_.corner_point, redo.corner_point);
  append(surface_.twin, redo.twin);
  append(surface_.appended, redo.triangles);
  append(parents_, redo.parents);
  newest_entry_.resize(surface_.triangle_count(), kNone);
  chain_new_parts();
  append(surface_.point_corner, redo.point_corner);
  append(surface_.appended_side, redo.side);
  append(vertex_mesh_, redo.vertex_mesh);
  next_side_ = redo.next_side;
  for (const LogEntry& entry : redo.changed) restore(entry);
  for (const auto& [point, corner] : redo.known_corners) surface_.point_corner[point] = corner;
  for (const SideEntry& entry : redo.sides) (*tear_sides(entry.mesh))[entry.vertex] = entry.side;
  for (const LogEntry& entry : redo.log) {
    newest_entry_[entry.triangle] = static_cast<Index>(log_.size());
    log_.push_back(entry);
  }
  append(side_log_, redo.side_log);
  for (Index m = 0; m < character_.meshes.size(); ++m)
    update_exact(
        m, character_.meshes[m].vertex_count() - static_cast<Index>(redo.meshes[m].records.size()));
  begin_stage();
}

}  // namespace sunder::tear
