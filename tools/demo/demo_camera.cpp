#include "tools/demo/demo_camera.h"

#include <algorithm>
#include <cmath>

#include "tools/picture/viewport.h"

namespace sunder::tools {
namespace {

constexpr std::size_t kMostPlaces = 20000;
constexpr double kSurroundings = 0.6;  ///< Around a wound in the closest view, in its lengths.

double extent(const std::vector<Vec3d>& places) {
  Bounds bounds;
  for (const Vec3d& place : places) {
    bounds.least = bounds.least.cwiseMin(place);
    bounds.greatest = bounds.greatest.cwiseMax(place);
  }
  return bounds.is_empty() ? 0 : bounds.size().norm();
}

}  // namespace

std::vector<Vec3d> places_of(const Character& character, const std::vector<DeformedMesh>& posed) {
  std::size_t count = 0;
  for (const Mesh& mesh : character.meshes) count += mesh.triangles.size();
  const std::size_t step = 1 + count / kMostPlaces;
  std::vector<Vec3d> places;
  std::size_t i = 0;
  for (std::size_t m = 0; m < posed.size(); ++m)
    for (const Triangle& triangle : character.meshes[m].triangles)
      if (i++ % step == 0 && !is_retired(triangle))
        for (const std::uint32_t vertex : triangle)
          places.emplace_back(posed[m].positions[vertex].cast<double>());
  return places;
}

Camera aim(const ViewFrame& frame, const std::vector<Vec3d>& places,
           const std::vector<Vec3d>& wound, double closeness) {
  Bounds of_wound;
  for (const Vec3d& place : wound) {
    of_wound.least = of_wound.least.cwiseMin(place);
    of_wound.greatest = of_wound.greatest.cwiseMax(place);
  }
  const double whole = extent(places), length = extent(wound);
  std::vector<Vec3d> shown;
  if (closeness > 0 && length > 0) {
    const double nearest = kSurroundings * length;
    const double radius =
        std::min(whole, std::pow(nearest, closeness) * std::pow(0.5 * whole, 1 - closeness));
    const Vec3d middle = of_wound.centre();
    for (const Vec3d& place : places)
      if ((place - middle).norm() < radius) shown.push_back(place);
    // A place at each side, where the model ends before: the wound stays in the middle.
    for (const double side : {-0.7, 0.7}) shown.push_back(middle + side * radius * frame.right);
  }
  if (shown.empty()) shown = places;
  return Viewport(frame, PictureSize(), shown).camera();
}

}  // namespace sunder::tools
