#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/internal/nearest_names.h"
#include "core/internal/ordered.h"
#include "pipeline/aim/operations.h"
#include "pipeline/aim/surface_path.h"

namespace sunder::aim {
namespace {

/// Places of the path that are nearer to one another, as a share of the model's size, are one.
constexpr double kSamePlaceSizes = 1e-7;
/// Neighbouring blades may differ by less than 90 degrees.
constexpr double kLeastCosine = 0.2;

Result<Index> find_mesh(const Character& character, const SurfacePlace& place, Index number) {
  if (const Index* const index = std::get_if<Index>(&place.mesh)) {
    if (*index < character.meshes.size()) return *index;
    return Status::failure(StatusCode::not_found, number,
                           "point %u: mesh %u does not exist; the model has %zu", number, *index,
                           character.meshes.size());
  }
  const std::string& name = std::get<std::string>(place.mesh);
  std::vector<std::string> names;
  for (Index i = 0; i < character.meshes.size(); ++i) {
    if (character.meshes[i].name == name) return i;
    names.push_back(character.meshes[i].name);
  }
  const std::string near = listed_names(nearest_names(name, names));
  return Status::failure(StatusCode::not_found, number, "point %u: no mesh is named '%.60s'%s%s%s",
                         number, name.c_str(), near.empty() ? "" : "; did you mean ", near.c_str(),
                         near.empty() ? "" : "?");
}

/// The face of the surface that is a triangle of a mesh.
Index face_of(const tear::Surface& surface, Index mesh, Index triangle) {
  const Index source_count = surface.first_triangle[mesh + 1] - surface.first_triangle[mesh];
  if (triangle < source_count) return surface.first_triangle[mesh] + triangle;
  for (Index i = 0; i < surface.appended.size(); ++i)
    if (surface.appended[i].mesh == mesh && surface.appended[i].triangle == triangle)
      return surface.first_triangle.back() + i;
  return kNone;
}

Result<FacePlace> find_place(const PosedSurface& surface, const SurfacePlace& place, Index number) {
  const Result<Index> mesh = find_mesh(surface.character(), place, number);
  if (!mesh) return mesh.error();
  const Index count = surface.character().meshes[*mesh].triangle_count();
  const Index face =
      place.triangle < count ? face_of(surface.surface(), *mesh, place.triangle) : kNone;
  if (face == kNone)
    return Status::failure(StatusCode::index_out_of_range, number,
                           "point %u: triangle %u does not exist; mesh %u has %u", number,
                           place.triangle, *mesh, count);
  if (!surface.is_live(face))
    return Status::failure(StatusCode::invalid_argument, number,
                           "point %u: triangle %u of mesh %u was removed or has no area", number,
                           place.triangle, *mesh);
  double sum = 0;
  for (const double part : place.barycentrics) sum += part;
  const bool is_inside =
      std::all_of(place.barycentrics.begin(), place.barycentrics.end(),
                  [](double part) { return part >= 0 && std::isfinite(part); }) &&
      sum > 0 && std::isfinite(sum);
  if (!is_inside)
    return Status::failure(StatusCode::invalid_argument, number,
                           "point %u: the barycentrics are not of a place in the triangle", number);
  FacePlace found{face, place.barycentrics};
  for (double& part : found.barycentrics) part /= sum;
  return found;
}

/// Blades along the normals. Where two neighbours would differ too much, one between them.
Stroke stroke_along(const std::vector<PathPlace>& path, double depth) {
  Stroke stroke;
  const auto add = [&](const Vec3d& position, const Vec3d& normal) {
    stroke.push_back({position + depth * normal, position - depth * normal});
  };
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0 && dot(path[i].normal, path[i - 1].normal) < kLeastCosine)
      add(0.5 * (path[i].position + path[i - 1].position),
          normalized(Vec3d(path[i].normal + path[i - 1].normal)));
    add(path[i].position, path[i].normal);
  }
  return stroke;
}

/// Leaves out places that coincide with the one before; the end stays.
void drop_repeated(std::vector<PathPlace>& path, double least) {
  std::vector<PathPlace> kept;
  for (const PathPlace& place : path)
    if (kept.empty() || norm(place.position - kept.back().position) > least) kept.push_back(place);
  path = std::move(kept);
}

}  // namespace

Result<Operation> resolve_incision(const PosedSurface& surface, const IncisionOperation& incision) {
  if (incision.points.size() < 2)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the incision has %zu points; it needs at least two",
                           incision.points.size());
  if (!(std::isfinite(incision.depth) && incision.depth > 0))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the depth of the incision is %g; expected above 0", incision.depth);
  std::vector<FacePlace> places;
  for (Index i = 0; i < incision.points.size(); ++i) {
    const Result<FacePlace> place = find_place(surface, incision.points[i], i);
    if (!place) return place.error();
    places.push_back(*place);
  }
  std::vector<PathPlace> path = {path_place(surface, places[0])};
  for (Index i = 1; i < places.size(); ++i)
    if (!append_path(surface, places[i - 1], places[i], path))
      return Status::failure(StatusCode::not_found, i,
                             "the surface does not connect point %u of the incision with point %u",
                             i - 1, i);
  drop_repeated(path, kSamePlaceSizes * surface.size());
  if (path.size() < 2)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "all points of the incision are one place");
  TearOperation tear;
  tear.pose = incision.pose;
  tear.stroke = stroke_along(path, incision.depth);
  tear.options = incision.options;
  return Operation(std::move(tear));
}

}  // namespace sunder::aim
