#include "tear/wound_mask/flat_faces.h"

#include <numbers>

#include "core/internal/elementary.h"
#include "core/internal/ordered.h"

namespace sunder::tear {
namespace {

constexpr double kSaddleRounding = 1e-9;  ///< Radians, of the sum of angles around a point.

std::array<double, 3> flat_shape(const std::array<Vec3d, 3>& at) {
  const Vec3d base = at[1] - at[0], side = at[2] - at[0];
  const double width = norm(base);
  if (!(width > 0)) return {0, 0, 0};
  return {width, dot(side, base) / width, norm(base.cross(side)) / width};
}

}  // namespace

FlatFaces::FlatFaces(const Character& source) : surface(build_surface(source)) {
  for (const Mesh& mesh : source.meshes)
    for (const Triangle& triangle : mesh.triangles)
      shapes.push_back(flat_shape({mesh.positions[triangle[0]].cast<double>(),
                                   mesh.positions[triangle[1]].cast<double>(),
                                   mesh.positions[triangle[2]].cast<double>()}));
  std::vector<double> around(surface.point_count(), 0.0);
  bends_paths.assign(surface.point_count(), false);
  angles.resize(3 * shapes.size());
  for (Index h = 0; h < angles.size(); ++h) {
    const Flat out = corner(Surface::next(h)) - corner(h),
               in = corner(Surface::previous(h)) - corner(h);
    angles[h] = elementary::atan2(cross(out, in), dot(out, in));
    around[surface.corner_point[h]] += angles[h];
    if (surface.twin[h] != kNone) continue;
    bends_paths[surface.corner_point[h]] = true;
    bends_paths[surface.corner_point[Surface::next(h)]] = true;
  }
  for (Index p = 0; p < around.size(); ++p)
    if (around[p] > 2 * std::numbers::pi + kSaddleRounding) bends_paths[p] = true;
}

FlatFaces::Turn FlatFaces::across(Index half_edge) const {
  const Index twin = surface.twin[half_edge];
  const Flat from = corner(Surface::next(half_edge)), to = corner(twin);
  const Flat before = unit(corner(half_edge) - from),
             after = unit(corner(Surface::next(twin)) - to);
  return {{dot(before, after), cross(before, after)}, from, to};
}

}  // namespace sunder::tear
