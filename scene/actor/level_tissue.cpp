#include "scene/actor/level_tissue.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace sunder::scene {
namespace {

std::vector<Vec3d> rest_places(const ParticleSet& particles, const ModelPose& pose) {
  std::vector<std::uint32_t> all(particles.particle_count());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<ParticleRest> rests(all.size());
  std::vector<Vec3d> places;
  if (!particles.rest(pose, all, rests)) return places;
  for (const ParticleRest& rest : rests) places.push_back(rest.place);
  return places;
}

}  // namespace

LevelTissue LevelTissue::of(const CharacterInstance& instance, const ModelPose& pose) {
  LevelTissue tissue;
  const SoftBody* const body = instance.body();
  if (body == nullptr || pose.model_from_bone.empty()) return tissue;
  tissue.places = rest_places(*instance.particles(), pose);
  const auto count = std::min<std::size_t>(tissue.places.size(), body->particle_count());
  tissue.places.resize(count);
  for (std::uint32_t p = 0; p < count; ++p)
    tissue.motions.push_back(
        {true, body->material_of(p), body->displacement(p), body->velocity(p)});
  return tissue;
}

/// The mean of the nearest four, which on either lip of a tear are mostly of that lip, because a
/// place is the centre of a particle. Weights are inverse squares of distances.
PointMotion LevelTissue::at(const Vec3d& place) const {
  constexpr std::size_t kNearest = 4;
  std::array<double, kNearest> distances;
  distances.fill(std::numeric_limits<double>::infinity());
  std::array<std::size_t, kNearest> nearest = {};
  for (std::size_t p = 0; p < places.size(); ++p) {
    double distance = (places[p] - place).squaredNorm();
    std::size_t of = p;
    for (std::size_t k = 0; k < kNearest; ++k)
      if (distance < distances[k]) {
        std::swap(distance, distances[k]);
        std::swap(of, nearest[k]);
      }
  }
  PointMotion mean = motions[nearest[0]];
  if (!(distances[0] > 0)) return mean;
  mean.displacement = mean.velocity = Vec3d::Zero();
  double sum = 0;
  for (std::size_t k = 0; k < kNearest && distances[k] < distances[0] * 1e6; ++k) {
    const double weight = distances[0] / distances[k];
    mean.displacement += weight * motions[nearest[k]].displacement;
    mean.velocity += weight * motions[nearest[k]].velocity;
    sum += weight;
  }
  mean.displacement /= sum;
  mean.velocity /= sum;
  return mean;
}

void LevelTissue::give_to(CharacterInstance& instance, const ModelPose& pose) const {
  SoftBody* const body = instance.body();
  if (body == nullptr || places.empty()) return;
  const ParticleSet& particles = *instance.particles();
  std::vector<PointMotion> of_particles;
  for (const Vec3d& place : rest_places(particles, pose)) of_particles.push_back(at(place));
  if (of_particles.size() != particles.particle_count()) return;
  std::vector<PointMotion> of_points(particles.point_count());
  for (std::size_t point = 0; point < of_points.size(); ++point) {
    const ParticleInfluences& of = particles.influences()[point];
    PointMotion& motion = of_points[point];
    motion.is_known = of.weights[0] > 0;
    if (motion.is_known) motion.material = of_particles[of.particles[0]].material;
    for (std::size_t k = 0; k < 4 && of.weights[k] > 0; ++k) {
      motion.displacement += double{of.weights[k]} * of_particles[of.particles[k]].displacement;
      motion.velocity += double{of.weights[k]} * of_particles[of.particles[k]].velocity;
    }
  }
  (void)body->inherit_motion_from(of_points);
}

}  // namespace sunder::scene
