#include "tear/improve.h"

#include <algorithm>

namespace sunder::tear {
namespace {

/// Least height over longest side, squared: 3/4 for an equilateral triangle, 0 for one without area.
double shape_squared(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double longest_squared = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest_squared > 0 ? (b - a).cross(c - a).squaredNorm() / (longest_squared * longest_squared) : 0.0;
}

/// By how much turning an edge makes the worse of its two faces better; at most 1 where it does not.
double gain(Index half_edge, const SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  const Index twin = surface.twin[half_edge];
  const Mesh& mesh = editor.character().meshes[surface.triangle(half_edge / 3).mesh];
  const auto position = [&](Index corner) -> Eigen::Vector3d { return mesh.positions[editor.vertex_at(corner)].cast<double>(); };
  const Eigen::Vector3d a = position(half_edge), b = position(Surface::next(half_edge)), c = position(Surface::previous(half_edge)),
                        d = position(Surface::previous(twin));
  const double before = std::min(shape_squared(a, b, c), shape_squared(b, a, d));
  const double after = std::min(shape_squared(a, d, c), shape_squared(b, c, d));
  return before > 0 ? after / before : after > 0 ? 2.0 : 0.0;
}

}  // namespace

void improve_faces(const SurfaceEditor::Mark& since, SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  std::vector<Index> faces, open;
  editor.for_each_changed(since, [&](Index face) { faces.push_back(face); });
  std::sort(faces.begin(), faces.end());
  for (Index face = since.triangles; face < surface.triangle_count(); ++face) faces.push_back(face);
  for (const Index face : faces)
    if (!surface.has_repeated_point(face)) open.insert(open.end(), {3 * face, 3 * face + 1, 3 * face + 2});
  std::size_t turns_left = 16 * open.size();
  while (!open.empty() && turns_left > 0) {
    const Index h = open.back();
    open.pop_back();
    if (!editor.is_inner_edge(h)) continue;
    const Index twin = surface.twin[h];
    if (!(gain(h, editor) > 1.0001) || !editor.flip_edge(h)) continue;
    --turns_left;
    for (const Index face : {h / 3, twin / 3}) open.insert(open.end(), {3 * face, 3 * face + 1, 3 * face + 2});
  }
}

}  // namespace sunder::tear
