#include "tools/demo/demo_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/picture/viewport.h"
#include "tools/render/triangle_tree.h"

namespace sunder::tools {
namespace {

constexpr std::size_t kMostPlaces = 20000;
constexpr double kGoodEnough = 0.55;   ///< Of the score of a wound that faces the eye.
constexpr double kSurroundings = 0.6;  ///< Around a wound in the closest view, in its lengths.

/// How well a wound is seen from a side: the mean, over its places, of the cosine to the line of
/// sight, or 0 where something hides it.
double score(const TriangleTree& tree, const Vec3d& towards_eye, const std::vector<Vec3d>& wound,
             const std::vector<Vec3d>& outwards, double diagonal) {
  double sum = 0;
  for (std::size_t i = 0; i < wound.size(); ++i) {
    const double facing = outwards[i].dot(towards_eye);
    if (facing <= 0) continue;
    const Vec3d from = wound[i] + 5e-3 * diagonal * outwards[i];
    if (!tree.is_blocked(from.cast<float>(), towards_eye.cast<float>(),
                         static_cast<float>(3 * diagonal)))
      sum += facing;
  }
  return wound.empty() ? 0 : sum / static_cast<double>(wound.size());
}

TriangleTree tree_of(const Character& character, const std::vector<DeformedMesh>& posed) {
  std::vector<TriangleTree::Corners> corners;
  for (std::size_t m = 0; m < posed.size(); ++m)
    for (const Triangle& triangle : character.meshes[m].triangles)
      if (!is_retired(triangle))
        corners.push_back({posed[m].positions[triangle[0]], posed[m].positions[triangle[1]],
                           posed[m].positions[triangle[2]]});
  return TriangleTree(corners);
}

double extent(const std::vector<Vec3d>& places) {
  Bounds bounds;
  for (const Vec3d& place : places) {
    bounds.least = bounds.least.cwiseMin(place);
    bounds.greatest = bounds.greatest.cwiseMax(place);
  }
  return bounds.is_empty() ? 0 : bounds.size().norm();
}

}  // namespace

ViewFrame choose_wound_view(const Character& character, const std::vector<DeformedMesh>& posed,
                            const std::vector<Vec3d>& wound, const std::vector<Vec3d>& outwards,
                            const ViewFrame& previous) {
  const TriangleTree tree = tree_of(character, posed);
  const double diagonal = bounds_of(character, posed).size().norm();
  const double before = score(tree, previous.towards_eye, wound, outwards, diagonal);
  if (wound.empty() || before > kGoodEnough) return previous;
  ViewFrame best = previous;
  double best_score = before + 0.1;
  for (const double elevation : {0.12, 0.45, 0.9, -0.25})
    for (int i = 0; i < 16; ++i) {
      const double angle = std::numbers::pi * i / 8;
      const ViewFrame frame = view_from({std::sin(angle), elevation, std::cos(angle)});
      const double near = frame.towards_eye.dot(previous.towards_eye);
      const double found = score(tree, frame.towards_eye, wound, outwards, diagonal) + 0.15 * near -
                           0.1 * std::abs(elevation - 0.12);
      if (found <= best_score) continue;
      best_score = found;
      best = frame;
    }
  return best;
}

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
