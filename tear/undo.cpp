#include <algorithm>

#include "tear/surface_editor.h"

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

SurfaceEditor::Step SurfaceEditor::finish(const Mark& begin) {
  Step step{begin, {}, {}};
  // Triangles that the operation made go away with it.
  std::copy_if(log_.begin() + static_cast<std::ptrdiff_t>(begin.log_length), log_.end(), std::back_inserter(step.log),
               [&](const LogEntry& entry) { return entry.triangle < begin.triangles; });
  step.side_log = tail_of(side_log_, begin.side_log_length);
  log_.resize(begin.log_length);
  side_log_.resize(begin.side_log_length);
  return step;
}

SurfaceEditor::Redo SurfaceEditor::undo(const Step& step, ChangeRecord& change) {
  const Mark& begin = step.begin;
  Redo redo;
  redo.step = step;
  for (Index m = 0; m < character_.meshes.size(); ++m) {
    const Mesh& mesh = character_.meshes[m];
    const Mark::MeshSizes& sizes = begin.meshes[m];
    Redo::OfMesh& of_mesh = redo.meshes.emplace_back();
    of_mesh.vertices = copy_vertices_from(sizes.vertices, mesh);
    of_mesh.triangles = tail_of(mesh.triangles, sizes.triangles);
    of_mesh.triangle_submesh = tail_of(mesh.triangle_submesh, sizes.triangles);
    of_mesh.submeshes = tail_of(mesh.submeshes, sizes.submeshes);
    of_mesh.custom_attributes = tail_of(mesh.custom_attributes, sizes.custom_attributes);
    for (CustomAttribute& attribute : of_mesh.custom_attributes) attribute.values.clear();
    of_mesh.births = tail_of(births_[m], sizes.vertices - source_.meshes[m].vertex_count());
    of_mesh.fillings = tail_of(fillings_[m], sizes.fillings);
    of_mesh.appended_triangles = tail_of(appended_triangles_[m], sizes.triangles - source_.meshes[m].triangle_count());
  }
  redo.corner_point = tail_of(surface_.corner_point, 3 * std::size_t{begin.triangles});
  redo.twin = tail_of(surface_.twin, 3 * std::size_t{begin.triangles});
  redo.triangles = tail_of(surface_.triangles, begin.triangles);
  redo.point_corner = tail_of(surface_.point_corner, begin.points);
  redo.point_side = tail_of(surface_.point_side, begin.points);
  redo.next_side = next_side_;
  for (const SideEntry& entry : step.side_log)
    redo.sides.push_back({entry.mesh, entry.vertex, tear_sides(entry.mesh)->values[entry.vertex]});

  // What the triangles are now, and the corners by which the points that they had or have are known.
  std::vector<Index> triangles;
  for (const LogEntry& entry : step.log) triangles.push_back(entry.triangle);
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  const std::size_t log_length = log_.size();
  for (const Index triangle : triangles) log_triangle(triangle);
  redo.changed = tail_of(log_, log_length);
  log_.resize(log_length);
  for (const LogEntry& entry : step.log)
    for (const Index point : entry.points)
      if (point != kNone && point < begin.points) redo.known_corners.push_back({point, surface_.point_corner[point]});

  append(log_, step.log);
  append(side_log_, step.side_log);
  Mark to = begin;
  to.log_length = log_length;
  to.side_log_length = side_log_.size() - step.side_log.size();
  roll_back(to);

  change = {};
  change.first_point = begin.points;
  for (Index m = 0; m < character_.meshes.size(); ++m) {
    MeshChange of_mesh;
    of_mesh.mesh = m;
    of_mesh.first_vertex = begin.meshes[m].vertices;
    of_mesh.first_triangle = begin.meshes[m].triangles;
    for (const LogEntry& entry : redo.changed) {
      const TriangleRef& ref = surface_.triangles[entry.triangle];
      if (ref.mesh == m && character_.meshes[m].triangles[ref.triangle] != entry.vertices)
        of_mesh.rewritten.push_back({ref.triangle, entry.vertices});
    }
    const Redo::OfMesh& undone = redo.meshes[m];
    if (of_mesh.rewritten.empty() && undone.births.empty() && undone.triangles.empty()) continue;
    fill_dirty_ranges(step.side_log, of_mesh);
    change.meshes.push_back(std::move(of_mesh));
  }
  return redo;
}

SurfaceEditor::Step SurfaceEditor::redo(const Redo& redo, ChangeRecord& change) {
  change = {};
  change.first_point = surface_.point_count();
  change.point_count = static_cast<Index>(redo.point_corner.size());
  for (Index m = 0; m < character_.meshes.size(); ++m) {
    Mesh& mesh = character_.meshes[m];
    const Redo::OfMesh& of = redo.meshes[m];
    MeshChange of_mesh;
    of_mesh.mesh = m;
    of_mesh.first_vertex = mesh.vertex_count();
    of_mesh.vertex_count = static_cast<Index>(of.births.size());
    of_mesh.first_triangle = mesh.triangle_count();
    of_mesh.triangle_count = static_cast<Index>(of.triangles.size());
    of_mesh.births = of.births;
    for (CustomAttribute attribute : of.custom_attributes) {
      attribute.values.assign(std::size_t{mesh.vertex_count()} * attribute.components, 0.0f);
      mesh.custom_attributes.push_back(std::move(attribute));
    }
    append_vertices(of.vertices, mesh);
    append(mesh.triangles, of.triangles);
    append(mesh.triangle_submesh, of.triangle_submesh);
    append(mesh.submeshes, of.submeshes);
    append(births_[m], of.births);
    append(fillings_[m], of.fillings);
    while (filling_serials_[m].size() < fillings_[m].size()) filling_serials_[m].push_back(next_serial_++);
    append(appended_triangles_[m], of.appended_triangles);
    for (const LogEntry& entry : redo.changed) {
      const TriangleRef& ref = surface_.triangles[entry.triangle];
      if (ref.mesh != m || mesh.triangles[ref.triangle] == entry.vertices) continue;
      of_mesh.rewritten.push_back({ref.triangle, mesh.triangles[ref.triangle]});
      if (is_retired(entry.vertices)) of_mesh.retired.push_back(ref.triangle);
    }
    for (Index t = of_mesh.first_triangle; t < mesh.triangle_count(); ++t)
      if (is_retired(mesh.triangles[t])) of_mesh.retired.push_back(t);
    if (of_mesh.rewritten.empty() && of.births.empty() && of.triangles.empty()) continue;
    fill_dirty_ranges(redo.sides, of_mesh);
    change.meshes.push_back(std::move(of_mesh));
  }
  append(surface_.corner_point, redo.corner_point);
  append(surface_.twin, redo.twin);
  append(surface_.triangles, redo.triangles);
  chain_new_parts();
  append(surface_.point_corner, redo.point_corner);
  append(surface_.point_side, redo.point_side);
  next_side_ = redo.next_side;
  for (const LogEntry& entry : redo.changed) restore(entry);
  for (const auto& [point, corner] : redo.known_corners) surface_.point_corner[point] = corner;
  for (const SideEntry& entry : redo.sides) tear_sides(entry.mesh)->values[entry.vertex] = entry.side;
  begin_stage();
  return redo.step;
}

}  // namespace sunder::tear
