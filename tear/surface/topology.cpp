#include <sunder/tear/topology.h>

#include <algorithm>
#include <utility>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/surface/joined_meshes.h"

namespace sunder {
namespace {
using tear::Surface;

Index count_components(const Surface& surface) {
  std::vector<bool> is_seen(surface.triangle_count(), false);
  std::vector<Index> open;
  Index components = 0;
  for (Index seed = 0; seed < surface.triangle_count(); ++seed) {
    if (is_seen[seed] || surface.has_repeated_point(seed)) continue;
    ++components;
    is_seen[seed] = true;
    open.push_back(seed);
    while (!open.empty()) {
      const Index triangle = open.back();
      open.pop_back();
      for (Index h = 3 * triangle; h < 3 * triangle + 3; ++h) {
        if (surface.twin[h] == kNone || is_seen[surface.twin[h] / 3]) continue;
        is_seen[surface.twin[h] / 3] = true;
        open.push_back(surface.twin[h] / 3);
      }
    }
  }
  return components;
}

bool is_border(const Surface& surface, Index half_edge) {
  return surface.twin[half_edge] == kNone && !surface.has_repeated_point(half_edge / 3);
}

/// The next half-edge on a border leaves the end point of this one; each point has one fan, hence
/// at most one such half-edge.
Index count_boundary_loops(const Surface& surface) {
  std::vector<bool> is_seen(surface.twin.size(), false);
  Index loops = 0;
  for (Index seed = 0; seed < surface.twin.size(); ++seed) {
    if (!is_border(surface, seed) || is_seen[seed]) continue;
    ++loops;
    for (Index h = seed; !is_seen[h];) {
      is_seen[h] = true;
      h = Surface::next(h);
      for (Index across = surface.twin[h]; across != kNone; across = surface.twin[h])
        h = Surface::next(across);
    }
  }
  return loops;
}

/// Whether a triangle is so thin that double arithmetic on float coordinates cannot tell it from
/// one without area.
bool has_no_area(const Mesh& mesh, const Triangle& triangle) {
  const Eigen::Vector3d a = mesh.positions[triangle[0]].cast<double>();
  const Eigen::Vector3d ab = mesh.positions[triangle[1]].cast<double>() - a,
                        ac = mesh.positions[triangle[2]].cast<double>() - a;
  const double longest_squared =
      std::max({squared_norm(ab), squared_norm(ac), squared_norm(ac - ab)});
  const Eigen::Vector3d doubled_area = ab.cross(ac);
  // Nearly all triangles have an area; most are seen to have one without a square root.
  const double surely_flat = 2 * tear::kFlatSquaredSizes * longest_squared;
  if (squared_norm(doubled_area) > surely_flat * surely_flat) return false;
  return norm(doubled_area) <= tear::kFlatSquaredSizes * longest_squared;
}

void count_triangles_and_points(const Character& character, const Surface& surface,
                                TopologyCounts& counts) {
  std::vector<bool> is_used(surface.point_count(), false);
  for (std::size_t m = 0; m < character.meshes.size(); ++m) {
    const Mesh& mesh = character.meshes[m];
    Index t = surface.first_triangle[m];
    for (const Triangle& triangle : mesh.triangles) {
      const Index first = 3 * t++;
      if (is_retired(triangle)) continue;
      ++counts.triangles;
      if (surface.has_repeated_point(first / 3) || has_no_area(mesh, triangle))
        ++counts.degenerate_triangles;
      for (Index corner = first; corner < first + 3; ++corner) {
        const Index point = surface.corner_point[corner];
        counts.points += is_used[point] ? 0 : 1;
        is_used[point] = true;
      }
    }
  }
}

void count_edges(const Surface& surface, TopologyCounts& counts) {
  Index half_edges = 0, border = 0;
  for (Index t = 0; t < surface.triangle_count(); ++t) {
    if (surface.has_repeated_point(t)) continue;
    half_edges += 3;
    for (Index h = 3 * t; h < 3 * t + 3; ++h) border += surface.twin[h] == kNone ? 1 : 0;
  }
  counts.edges = (half_edges + border) / 2;
  counts.boundary_edges = border - surface.non_manifold_half_edges;
  counts.non_manifold_edges = surface.non_manifold_edges;
}

TopologyCounts count(const Character& character, const Surface& surface) {
  TopologyCounts counts;
  for (const Mesh& mesh : character.meshes) counts.vertices += mesh.vertex_count();
  count_triangles_and_points(character, surface, counts);
  count_edges(surface, counts);
  counts.boundary_loops = count_boundary_loops(surface);
  counts.components = count_components(surface);
  return counts;
}

}  // namespace

Result<TopologyCounts> count_topology(const Character& character,
                                      std::vector<std::uint32_t>* points_of_mesh) {
  return or_out_of_memory([&]() -> Result<TopologyCounts> {
    if (points_of_mesh == nullptr) return count(character, tear::build_surface(character));
    tear::JoinedMeshes joined = tear::join_meshes(character);
    *points_of_mesh = std::move(joined.points_of_mesh);
    return count(character, joined.surface);
  });
}

}  // namespace sunder
