#include "bench/tear/tear_scene.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>

#include "bench/harness/subdivided_model.h"
#include "support/models/rigs.h"

namespace sunder::bench {
namespace {

constexpr std::uint32_t kBones = 64;
constexpr std::uint32_t kWantedFaces = 100;
constexpr std::size_t kPoses = 8;

/// All bones rotate by the same angle, so that the chain is an arc of `angle` radians.
ModelPose bend(const Character& character, double angle) {
  Pose pose = *local_rest_pose(character);
  const Quatd turn(Eigen::AngleAxisd(angle / kBones, Eigen::Vector3d::UnitY()));
  for (BoneTransform& bone : pose.parent_from_bone)
    bone.rotation = Quatf((bone.rotation.cast<double>() * turn).normalized().cast<float>());
  ModelPose result;
  if (!compute_model_pose(character.skeleton, pose, result)) std::abort();
  return result;
}

/// Parallel blades next to each other along the side of the posed model, from outside its box to
/// its middle.
Stroke stroke_of_length(const Eigen::AlignedBox3d& box, double length) {
  constexpr int kSegments = 4;
  constexpr double kSlope =
      -25 * std::numbers::pi / 180;  // where the bunny's side is longest and has no folds
  const Vec3d middle =
      box.min() + Eigen::Vector3d(box.sizes().cwiseProduct(Eigen::Vector3d(0.52, 0.3, 0.5)));
  const Vec3d along(std::cos(kSlope), std::sin(kSlope), 0), outwards(0, 0, -0.6 * box.sizes().z());
  Stroke stroke;
  for (int i = 0; i <= kSegments; ++i) {
    const Vec3d tip = middle + (static_cast<double>(i) / kSegments - 0.5) * length * along;
    stroke.push_back({tip + outwards, tip});
  }
  return stroke;
}

/// Extends the stroke until it crosses the requested number of faces in the first pose.
void fit_stroke(const Eigen::AlignedBox3d& box, Scene& scene) {
  double shorter = 0, longer = box.sizes().x();
  for (int i = 0;
       i < 20 && (scene.faces_crossed < kWantedFaces - 2 || scene.faces_crossed > kWantedFaces + 2);
       ++i) {
    const double length = 0.5 * (shorter + longer);
    scene.stroke = stroke_of_length(box, length);
    const auto report = scene.model().tear(scene.poses[0], scene.stroke);
    if (!report) std::abort();
    scene.faces_crossed = report->faces_crossed;
    (scene.faces_crossed < kWantedFaces ? shorter : longer) = length;
    if (report->runs > 0 && !scene.model().undo()) std::abort();
  }
}

}  // namespace

std::string size_name(int divisions) {
  switch (divisions) {
    case 1: return "3k";
    case 2: return "14k";
    case 3: return "31k";
    case 5: return "87k";
    case 7: return "171k";
    default: return "900k";
  }
}

std::vector<Vec3d> posed_positions(const Scene& scene, const ModelPose& pose) {
  return test::posed_positions(*scene.character, 0, pose);
}

const Scene& scene_of(int divisions) {
  static std::map<int, Scene> scenes;
  const auto [known, is_new] = scenes.try_emplace(divisions);
  Scene& scene = known->second;
  if (!is_new) return scene;
  scene.character = std::make_shared<const Character>(make_subdivided_model(divisions, kBones));
  for (std::size_t i = 0; i < kPoses; ++i)
    scene.poses.push_back(bend(*scene.character, 0.6 + 1e-4 * static_cast<double>(i)));
  auto model = TornModel::create(scene.character, {100000, 100000, 16});
  if (!model) std::abort();
  scene.model_ = std::make_unique<TornModel>(std::move(*model));
  Eigen::AlignedBox3d box;
  Vec3d sum = Vec3d::Zero();
  const std::vector<Vec3d> positions = posed_positions(scene, scene.poses[0]);
  for (const Vec3d& position : positions) {
    box.extend(Eigen::Vector3d(position));
    sum += position;
  }
  scene.middle_plane = {sum / static_cast<double>(positions.size()), {1, 0.1, 0.2}, {}, false};
  fit_stroke(box, scene);
  std::fprintf(stderr, "%s %s: %u points, %u faces; the stroke crosses %u\n",
               scene.character->name.c_str(), size_name(divisions).c_str(),
               scene.mesh().vertex_count(), scene.mesh().triangle_count(), scene.faces_crossed);
  return scene;
}

}  // namespace sunder::bench
