#include "pipeline/binding/welded_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "core/internal/ordered.h"

namespace sunder::binding {
namespace {

struct Place {
  std::tuple<float, float, float, float> key;  ///< Position and tear side.
  Index mesh, vertex;
};

std::span<const float> tear_sides(const Mesh& mesh) {
  for (const CustomAttribute& attribute : mesh.custom_attributes)
    if (attribute.name == kTearSideAttribute && attribute.components == 1) return attribute.values;
  return {};
}

void join_vertices(const Joined& joined, WeldedSurface& surface) {
  std::vector<Place> places;
  for (Index m = 0; m < joined.positions.size(); ++m) {
    const std::span<const float> sides = tear_sides(joined.model.meshes[m]);
    for (Index v = 0; v < joined.positions[m].size(); ++v) {
      // -0 + 0 = +0: the two compare equal but would sort apart otherwise.
      const Vec3f p = joined.positions[m][v].cast<float>() + Vec3f::Zero();
      places.push_back({{p.x(), p.y(), p.z(), sides.empty() ? 0.0f : sides[v]}, m, v});
    }
    surface.point_of_vertex.emplace_back(joined.positions[m].size(), kNone);
  }
  std::ranges::sort(places, [](const Place& a, const Place& b) {
    return std::tie(a.key, a.mesh, a.vertex) < std::tie(b.key, b.mesh, b.vertex);
  });
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& place = places[i];
    if (i == 0 || place.key != places[i - 1].key)
      surface.positions.push_back(joined.positions[place.mesh][place.vertex]);
    surface.point_of_vertex[place.mesh][place.vertex] = surface.point_count() - 1;
  }
}

/// Whether double arithmetic on float coordinates can tell a triangle from one without area.
bool has_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a;
  const double longest = std::max({squared_norm(ab), squared_norm(ac), squared_norm(ac - ab)});
  return norm(ab.cross(ac)) > 1e-10 * longest;
}

void collect_triangles(const Joined& joined, WeldedSurface& surface) {
  for (Index m = 0; m < joined.model.meshes.size(); ++m)
    for (const Triangle& triangle : joined.model.meshes[m].triangles) {
      Triangle points;
      for (std::size_t k = 0; k < 3; ++k) points[k] = surface.point_of_vertex[m][triangle[k]];
      std::rotate(points.begin(), std::ranges::min_element(points), points.end());
      if (points[0] != points[1] && points[1] != points[2] && points[2] != points[0])
        surface.triangles.push_back(points);
    }
  std::ranges::sort(surface.triangles);
  for (const auto& [a, b, c] : surface.triangles)
    surface.has_area.push_back(
        has_area(surface.positions[a], surface.positions[b], surface.positions[c]));
}

void find_parts(WeldedSurface& surface) {
  std::vector<Index> root(surface.positions.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](Index i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  std::vector<bool> has_triangle(root.size(), false);
  for (const Triangle& triangle : surface.triangles)
    for (const Index point : triangle) {
      has_triangle[point] = true;
      const Index a = find(triangle[0]), b = find(point);
      root[std::max(a, b)] = std::min(a, b);
    }
  surface.part_of_point.assign(root.size(), kNone);
  for (Index i = 0; i < root.size(); ++i)
    if (has_triangle[i])
      surface.part_of_point[i] =
          find(i) == i ? surface.part_count++ : surface.part_of_point[find(i)];
}

void find_closed_parts(WeldedSurface& surface) {
  std::vector<std::pair<Index, Index>> edges;
  for (const Triangle& triangle : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(triangle[k], triangle[(k + 1) % 3]);
  std::ranges::sort(edges);
  surface.is_closed.assign(surface.part_count, true);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool is_twice = i > 0 && edges[i] == edges[i - 1];
    const std::pair back(edges[i].second, edges[i].first);
    if (is_twice || !std::ranges::binary_search(edges, back))
      surface.is_closed[surface.part_of_point[edges[i].first]] = false;
  }
}

}  // namespace

WeldedSurface weld(const Joined& joined) {
  WeldedSurface surface;
  join_vertices(joined, surface);
  collect_triangles(joined, surface);
  find_parts(surface);
  find_closed_parts(surface);
  Eigen::AlignedBox3d box;
  for (const Vec3d& position : surface.positions) box.extend(Eigen::Vector3d(position));
  surface.diagonal = surface.positions.empty() ? 0.0 : norm(Vec3d(box.diagonal()));
  return surface;
}

}  // namespace sunder::binding
