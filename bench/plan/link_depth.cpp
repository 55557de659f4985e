#include "bench/plan/link_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "support/machine/random.h"
#include "support/models/rigs.h"

namespace sunder::bench {
namespace {

constexpr std::size_t kMostVertices = 60;  ///< Of a link.
constexpr std::size_t kPlaces = 5000;      ///< Random ones on faces, besides all vertices.
constexpr std::size_t kMostMoments = 256;  ///< That are kept.

std::vector<std::vector<Vec3d>> all_posed(const Character& character, const ModelPose& pose) {
  std::vector<std::vector<Vec3d>> posed;
  for (std::uint32_t mesh = 0; mesh < character.meshes.size(); ++mesh)
    posed.push_back(test::posed_positions(character, mesh, pose));
  return posed;
}

/// Random places, evenly by area in a pose.
std::vector<SurfaceAnchor> random_places(const Character& character, const ModelPose& pose) {
  const auto posed = all_posed(character, pose);
  std::vector<SurfaceAnchor> faces;
  std::vector<double> sums;
  double sum = 0;
  for (std::uint32_t mesh = 0; mesh < character.meshes.size(); ++mesh)
    for (std::uint32_t i = 0; i < character.meshes[mesh].triangle_count(); ++i) {
      const Triangle& corners = character.meshes[mesh].triangles[i];
      const Vec3d& a = posed[mesh][corners[0]];
      sum += (posed[mesh][corners[1]] - a).cross(posed[mesh][corners[2]] - a).norm();
      sums.push_back(sum);
      faces.push_back({mesh, {i, {1, 0, 0}}});
    }
  test::Random random(3);
  std::vector<SurfaceAnchor> places;
  for (std::size_t i = 0; i < kPlaces && sum > 0; ++i) {
    const auto found = std::upper_bound(sums.begin(), sums.end(), random.uniform(0, sum));
    SurfaceAnchor place =
        faces[std::min(static_cast<std::size_t>(found - sums.begin()), faces.size() - 1)];
    const double root = std::sqrt(random.uniform(0, 1)), second = random.uniform(0, 1);
    place.birth.barycentric = {1 - root, root * (1 - second), root * second};
    places.push_back(place);
  }
  return places;
}

double radius_of(const Collider& collider) {
  if (const auto* const ball = std::get_if<Collider::Sphere>(&collider.shape)) return ball->radius;
  if (const auto* const capsule = std::get_if<Collider::Capsule>(&collider.shape))
    return capsule->radius + capsule->half_length;
  if (const auto* const box = std::get_if<Collider::Box>(&collider.shape))
    return box->half_size.norm();
  return std::numeric_limits<double>::infinity();
}

}  // namespace

LinkDepth::LinkDepth(const PlanCase& of)
    : of_(of), model_(*TornModel::create(of.rig.character)), vertices_(of.vertices.size()) {
  for (std::size_t link = 0; link < of.vertices.size(); ++link) {
    const std::size_t stride = of.vertices[link].size() / kMostVertices + 1;
    for (std::size_t v = 0; v < of.vertices[link].size(); v += stride)
      vertices_[link].push_back(of.vertices[link][v]);
  }
  if (const auto pose = make_pose(*of.rig.character, of.timing.pose))
    anchors_ = random_places(*of.rig.character, *pose);
}

LinkDepth::Moment& LinkDepth::at(double time) {
  const auto known = std::find_if(moments_.begin(), moments_.end(),
                                  [&](const Moment& moment) { return moment.time == time; });
  if (known != moments_.end()) return *known;
  if (moments_.size() == kMostMoments) moments_.clear();
  Moment moment{time, {}, *SurfaceQuery::create(model_), false};
  ClipPose clip = std::get<ClipPose>(of_.timing.pose);
  clip.time += of_.timing.clip_speed * time;
  if (const auto pose = make_pose(*of_.rig.character, clip); pose && moment.query.set_pose(*pose)) {
    moment.is_posed = true;
    const auto posed = all_posed(*of_.rig.character, *pose);
    for (const std::vector<Vec3d>& of_mesh : posed)
      moment.places.insert(moment.places.end(), of_mesh.begin(), of_mesh.end());
    for (const SurfaceAnchor& anchor : anchors_) {
      Vec3d place = Vec3d::Zero();
      const Triangle& corners =
          of_.rig.character->meshes[anchor.mesh].triangles[anchor.birth.triangle];
      for (std::size_t i = 0; i < 3; ++i)
        place += anchor.birth.barycentric[i] * posed[anchor.mesh][corners[i]];
      moment.places.push_back(place);
    }
  }
  moments_.push_back(std::move(moment));
  return moments_.back();
}

double LinkDepth::deepest_vertex(double time, std::span<const Affine3d> frames) {
  Moment& moment = at(time);
  if (!moment.is_posed) return std::numeric_limits<double>::infinity();
  double deepest = 0;
  for (std::uint32_t link = 0; link < frames.size(); ++link) {
    if (link == of_.tool.blade.link) continue;
    for (const Vec3d& vertex : vertices_[link]) {
      const auto found = moment.query.find_nearest(frames[link] * vertex, 0.5 * of_.rig.size);
      if (found && found->has_value()) deepest = std::max(deepest, (*found)->depth);
    }
  }
  return deepest;
}

double LinkDepth::least_distance(double time, std::span<const Affine3d> frames, double most) {
  Moment& moment = at(time);
  if (!moment.is_posed) return -std::numeric_limits<double>::infinity();
  double least = most;
  for (const BoneCollider& shape : of_.tool.shapes) {
    if (shape.bone == of_.tool.blade.link) continue;
    const Collider posed = posed_collider(shape, frames[shape.bone]);
    const double radius = radius_of(posed);
    for (const Vec3d& place : moment.places) {
      const double far = radius + least;
      if ((place - posed.place).squaredNorm() < far * far)
        least = std::min(least, distance_to(posed, place).distance);
    }
    if (least <= 0) return least;
  }
  for (const BoneCollider& shape : of_.tool.shapes) {  // that the surface does not pass through
    if (shape.bone == of_.tool.blade.link) continue;
    const Vec3d middle = posed_collider(shape, frames[shape.bone]).place;
    const auto found = moment.query.find_nearest(middle, of_.rig.size);
    if (found && found->has_value() && (*found)->depth > 0) return -(*found)->depth;
  }
  return least;
}

bool LinkDepth::is_blade_outside(double time, const Vec3d& base, const Vec3d& entry) {
  Moment& moment = at(time);
  if (!moment.is_posed) return false;
  constexpr int kSteps = 10;
  for (int i = 1; i <= kSteps; ++i) {
    const Vec3d point = entry + static_cast<double>(i) / kSteps * (base - entry);
    const auto found = moment.query.find_nearest(point, of_.rig.size);
    if (found && found->has_value() && (*found)->depth > 0) return false;
  }
  return true;
}

}  // namespace sunder::bench
