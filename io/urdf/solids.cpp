#include "io/urdf/solids.h"

#include <cmath>
#include <numbers>

namespace sunder::urdf {
namespace {

constexpr std::uint32_t kSides = 32;
constexpr std::uint32_t kMeridians = 24, kParallels = 12;

std::uint32_t add_vertex(Mesh& mesh, const Vec3d& position, const Vec3d& normal) {
  mesh.positions.push_back(position.cast<float>());
  mesh.normals.push_back(normal.cast<float>());
  return mesh.vertex_count() - 1;
}

void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangle_submesh.push_back(0);
}

Mesh empty_mesh() {
  Mesh mesh;
  mesh.submeshes.emplace_back();
  return mesh;
}

/// A disc that faces up or down the z axis.
void add_cap(Mesh& mesh, double radius, double z, double up) {
  const Vec3d normal(0, 0, up);
  const std::uint32_t centre = add_vertex(mesh, Vec3d(0, 0, z), normal);
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    add_vertex(mesh, Vec3d(radius * std::cos(angle), radius * std::sin(angle), z), normal);
  }
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t a = centre + 1 + i, b = centre + 1 + (i + 1) % kSides;
    if (up > 0)
      add_triangle(mesh, centre, a, b);
    else
      add_triangle(mesh, centre, b, a);
  }
}

}  // namespace

Mesh box_mesh(const BoxTag& box) {
  Mesh mesh = empty_mesh();
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      Vec3d normal = Vec3d::Zero();
      normal[axis] = side;
      const std::uint32_t first = mesh.vertex_count();
      // Counter-clockwise about the normal, as (u, v, axis) is right-handed.
      const double corners[4][2] = {{-1, -side}, {1, -side}, {1, side}, {-1, side}};
      for (const auto& corner : corners) {
        Vec3d position;
        position[axis] = 0.5 * side * box.size[static_cast<std::size_t>(axis)];
        position[u] = 0.5 * corner[0] * box.size[static_cast<std::size_t>(u)];
        position[v] = 0.5 * corner[1] * box.size[static_cast<std::size_t>(v)];
        add_vertex(mesh, position, normal);
      }
      add_triangle(mesh, first, first + 1, first + 2);
      add_triangle(mesh, first, first + 2, first + 3);
    }
  return mesh;
}

Mesh cylinder_mesh(const CylinderTag& cylinder) {
  Mesh mesh = empty_mesh();
  const double half = 0.5 * cylinder.length;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    const Vec3d normal(std::cos(angle), std::sin(angle), 0);
    for (const double z : {-half, half})
      add_vertex(mesh, Vec3d(cylinder.radius * normal.x(), cylinder.radius * normal.y(), z),
                 normal);
  }
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % kSides);
    add_triangle(mesh, a, b, b + 1);
    add_triangle(mesh, a, b + 1, a + 1);
  }
  add_cap(mesh, cylinder.radius, half, 1);
  add_cap(mesh, cylinder.radius, -half, -1);
  return mesh;
}

Mesh sphere_mesh(const SphereTag& sphere) {
  Mesh mesh = empty_mesh();
  const auto add = [&](const Vec3d& normal) { add_vertex(mesh, sphere.radius * normal, normal); };
  add(Vec3d(0, 0, -1));
  for (std::uint32_t row = 1; row < kParallels; ++row) {
    const double latitude = std::numbers::pi * (row / static_cast<double>(kParallels) - 0.5);
    for (std::uint32_t i = 0; i < kMeridians; ++i) {
      const double angle = 2 * std::numbers::pi * i / kMeridians;
      add(Vec3d(std::cos(latitude) * std::cos(angle), std::cos(latitude) * std::sin(angle),
                std::sin(latitude)));
    }
  }
  add(Vec3d(0, 0, 1));
  const auto at = [](std::uint32_t row, std::uint32_t i) {
    return 1 + (row - 1) * kMeridians + i % kMeridians;
  };
  const std::uint32_t last = mesh.vertex_count() - 1;
  for (std::uint32_t i = 0; i < kMeridians; ++i) {
    add_triangle(mesh, 0, at(1, i + 1), at(1, i));
    for (std::uint32_t row = 1; row + 1 < kParallels; ++row) {
      add_triangle(mesh, at(row, i), at(row, i + 1), at(row + 1, i + 1));
      add_triangle(mesh, at(row, i), at(row + 1, i + 1), at(row + 1, i));
    }
    add_triangle(mesh, at(kParallels - 1, i), at(kParallels - 1, i + 1), last);
  }
  return mesh;
}

}  // namespace sunder::urdf
