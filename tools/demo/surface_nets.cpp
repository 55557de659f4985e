#include "tools/demo/surface_nets.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sunder::tools {
namespace {

using Field = std::function<double(const Vec3d&)>;

Vec3d gradient(const Field& field, const Vec3d& position) {
  constexpr double kStep = 1e-4;
  Vec3d result;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d step = Vec3d::Zero();
    step[axis] = kStep;
    result[axis] = (field(position + step) - field(position - step)) / (2 * kStep);
  }
  return result;
}

/// Field values at the nodes of a box of cubes.
struct Grid {
  Vec3d origin;
  double cell = 0;
  std::array<Index, 3> nodes = {};
  std::vector<double> values;

  [[nodiscard]] Index node(Index x, Index y, Index z) const {
    return (z * nodes[1] + y) * nodes[0] + x;
  }
  [[nodiscard]] Vec3d position(Index x, Index y, Index z) const {
    return origin + cell * Vec3d(x, y, z);
  }
};

Grid sample(const Field& field, const Vec3d& box_min, const Vec3d& box_max, double cell) {
  Grid grid{box_min, cell, {}, {}};
  for (int axis = 0; axis < 3; ++axis)
    grid.nodes[axis] = static_cast<Index>(std::ceil((box_max[axis] - box_min[axis]) / cell)) + 1;
  grid.values.reserve(std::size_t{grid.nodes[0]} * grid.nodes[1] * grid.nodes[2]);
  for (Index z = 0; z < grid.nodes[2]; ++z)
    for (Index y = 0; y < grid.nodes[1]; ++y)
      for (Index x = 0; x < grid.nodes[0]; ++x)
        grid.values.push_back(field(grid.position(x, y, z)));
  return grid;
}

/// The mean of the crossings on the edges of the cube whose lowest corner is (x, y, z); false if
/// there are none.
bool mean_crossing(const Grid& grid, Index x, Index y, Index z, Vec3d& mean) {
  mean.setZero();
  int count = 0;
  for (Index axis = 0; axis < 3; ++axis)
    for (Index side = 0; side < 4; ++side) {
      std::array<Index, 3> a = {x, y, z};
      a[(axis + 1) % 3] += side & 1u;
      a[(axis + 2) % 3] += side >> 1u;
      std::array<Index, 3> b = a;
      ++b[axis];
      const double at_a = grid.values[grid.node(a[0], a[1], a[2])],
                   at_b = grid.values[grid.node(b[0], b[1], b[2])];
      if ((at_a < 0) == (at_b < 0)) continue;
      const double t = at_a / (at_a - at_b);
      mean += (1 - t) * grid.position(a[0], a[1], a[2]) + t * grid.position(b[0], b[1], b[2]);
      ++count;
    }
  if (count > 0) mean /= count;
  return count > 0;
}

/// The points in the four cubes that share the edge from a node along an axis, once around it.
std::array<Index, 4> points_around(const Grid& grid, const std::vector<Index>& point_of_cube,
                                   const std::array<Index, 3>& node, Index axis) {
  std::array<Index, 4> points = {};
  for (Index side = 0; side < 4; ++side) {
    std::array<Index, 3> cube = node;
    const Index around = side ^ (side >> 1u);  // 0, 1, 3, 2
    cube[(axis + 1) % 3] -= 1 - (around & 1u);
    cube[(axis + 2) % 3] -= 1 - (around >> 1u);
    points[side] = point_of_cube[grid.node(cube[0], cube[1], cube[2])];
  }
  return points;
}

void append_quad(PointSurface& surface, const std::array<Index, 4>& corners) {
  const auto squared_diagonal = [&](int a, int b) {
    return (surface.positions[corners[a]] - surface.positions[corners[b]]).squaredNorm();
  };
  if (squared_diagonal(0, 2) <= squared_diagonal(1, 3)) {
    surface.triangles.push_back({corners[0], corners[1], corners[2]});
    surface.triangles.push_back({corners[0], corners[2], corners[3]});
  } else {
    surface.triangles.push_back({corners[0], corners[1], corners[3]});
    surface.triangles.push_back({corners[1], corners[2], corners[3]});
  }
}

/// A grid edge that the surface crosses is shared by four cubes: their points make a quad.
void append_quads(PointSurface& surface, const Grid& grid, const std::vector<Index>& point_of_cube,
                  const std::array<Index, 3>& node) {
  const bool begins_inside = grid.values[grid.node(node[0], node[1], node[2])] < 0;
  for (Index axis = 0; axis < 3; ++axis) {
    std::array<Index, 3> end = node;
    ++end[axis];
    if (begins_inside == (grid.values[grid.node(end[0], end[1], end[2])] < 0)) continue;
    std::array<Index, 4> quad = points_around(grid, point_of_cube, node, axis);
    if (!begins_inside) std::reverse(quad.begin(), quad.end());
    append_quad(surface, quad);
  }
}

}  // namespace

Vec3d field_normal(const Field& field, const Vec3d& position) {
  return gradient(field, position).normalized();
}

PointSurface surface_nets(const Field& field, const Vec3d& box_min, const Vec3d& box_max,
                          double cell) {
  const Grid grid = sample(field, box_min, box_max, cell);
  PointSurface surface;
  std::vector<Index> point_of_cube(grid.values.size(), kNone);
  for (Index z = 0; z + 1 < grid.nodes[2]; ++z)
    for (Index y = 0; y + 1 < grid.nodes[1]; ++y)
      for (Index x = 0; x + 1 < grid.nodes[0]; ++x) {
        Vec3d position;
        if (!mean_crossing(grid, x, y, z, position)) continue;
        for (int step = 0; step < 3; ++step) {
          const Vec3d slope = gradient(field, position);
          position -= field(position) / slope.squaredNorm() * slope;
        }
        point_of_cube[grid.node(x, y, z)] = static_cast<Index>(surface.positions.size());
        surface.positions.push_back(position);
      }

  for (Index z = 1; z + 1 < grid.nodes[2]; ++z)
    for (Index y = 1; y + 1 < grid.nodes[1]; ++y)
      for (Index x = 1; x + 1 < grid.nodes[0]; ++x)
        append_quads(surface, grid, point_of_cube, {x, y, z});
  return surface;
}

}  // namespace sunder::tools
