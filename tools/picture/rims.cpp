#include "tools/picture/rims.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sunder::tools {
namespace {

struct Corner {
  Index mesh, triangle, corner;

  auto operator<=>(const Corner&) const = default;
};

/// The corners at which border edges begin, ascending.
std::vector<Corner> find_borders(const TornModel& model) {
  std::vector<std::array<Index, 2>> edges;
  const auto for_each_edge = [&](const auto& visit) {
    const auto& meshes = model.character().meshes;
    for (Index mesh = 0; mesh < meshes.size(); ++mesh)
      for (Index t = 0; t < meshes[mesh].triangles.size(); ++t)
        for (Index corner = 0; corner < 3 && !is_retired(meshes[mesh].triangles[t]); ++corner)
          visit(Corner{mesh, t, corner}, model.point_at(mesh, t, corner),
                model.point_at(mesh, t, (corner + 1) % 3));
  };
  for_each_edge([&](const Corner&, Index a, Index b) { edges.push_back({a, b}); });
  std::sort(edges.begin(), edges.end());
  std::vector<Corner> borders;
  for_each_edge([&](const Corner& at, Index a, Index b) {
    if (!std::binary_search(edges.begin(), edges.end(), std::array<Index, 2>{b, a}))
      borders.push_back(at);
  });
  return borders;
}

/// Whether a place on a triangle lies on the side that begins at a corner.
bool is_on_side(const Mesh& mesh, const Triangle& triangle, Index corner, const Vec3f& place) {
  const auto position = [&](Index k) {
    return mesh.positions[triangle[(corner + k) % 3]].cast<double>();
  };
  const Vec3d along = position(1) - position(0), up = position(2) - position(0),
              offset = place.cast<double>() - position(0);
  return along.cross(offset).norm() < 1e-4 * along.cross(up).norm();
}

}  // namespace

std::vector<RimEdge> find_rims(const TornModel& model) {
  const auto source =
      TornModel::create(std::shared_ptr<const Character>(std::shared_ptr<void>(), &model.source()));
  if (!source) return {};
  const std::vector<Corner> source_borders = find_borders(*source);
  std::vector<RimEdge> rims;
  for (const Corner& at : find_borders(model)) {
    const Mesh &mesh = model.character().meshes[at.mesh], &before = model.source().meshes[at.mesh];
    const RimEdge edge{at.mesh, mesh.triangles[at.triangle][at.corner],
                       mesh.triangles[at.triangle][(at.corner + 1) % 3], at.triangle};
    const Index parent = model.source_triangle(at.mesh, at.triangle);
    if (parent >= before.triangle_count()) continue;
    bool was_border = false;
    for (Index corner = 0; corner < 3 && !was_border; ++corner)
      was_border = std::binary_search(source_borders.begin(), source_borders.end(),
                                      Corner{at.mesh, parent, corner}) &&
                   is_on_side(before, before.triangles[parent], corner, mesh.positions[edge.a]) &&
                   is_on_side(before, before.triangles[parent], corner, mesh.positions[edge.b]);
    if (!was_border) rims.push_back(edge);
  }
  return rims;
}

std::vector<RimEdge> find_borders_at(const TornModel& model, const std::vector<bool>& is_wanted) {
  const auto wants = [&](Index point) { return point < is_wanted.size() && is_wanted[point]; };
  std::vector<std::array<Index, 2>> edges;
  std::vector<std::pair<RimEdge, std::array<Index, 2>>> found;
  const auto& meshes = model.character().meshes;
  for (Index m = 0; m < meshes.size(); ++m)
    for (Index t = 0; t < meshes[m].triangle_count(); ++t) {
      const Triangle& triangle = meshes[m].triangles[t];
      if (is_retired(triangle)) continue;
      const std::array<Index, 3> points = {model.point_at(m, t, 0), model.point_at(m, t, 1),
                                           model.point_at(m, t, 2)};
      if (std::none_of(points.begin(), points.end(), wants)) continue;
      const bool is_filling =
          model.source_triangle(m, t) >= model.source().meshes[m].triangle_count();
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t next = (c + 1) % 3;
        if (!wants(points[c]) && !wants(points[next])) continue;
        edges.push_back({points[c], points[next]});
        if (!is_filling)
          found.push_back({{m, triangle[c], triangle[next], t}, {points[next], points[c]}});
      }
    }
  std::sort(edges.begin(), edges.end());
  std::vector<RimEdge> borders;
  for (const auto& [edge, reversed] : found)
    if (!std::binary_search(edges.begin(), edges.end(), reversed)) borders.push_back(edge);
  return borders;
}

}  // namespace sunder::tools
