#pragma once

#include <sunder/particles/soft_body.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "support/models/rigs.h"

namespace sunder::test {

/// A model, its particles and their motion.
struct SoftScene {
  std::shared_ptr<const Character> character;
  std::unique_ptr<TornModel> model;
  ModelPose pose;
  std::unique_ptr<ParticleSet> set;
  std::unique_ptr<SoftBody> body;

  explicit SoftScene(Character from, const SoftMaterial& material = {}, double range = 0.1,
                     const SoftBodyOptions& options = {})
      : SoftScene(std::move(from), std::vector<SoftMaterial>{material}, range, options) {}

  SoftScene(Character from, const std::vector<SoftMaterial>& materials, double range,
            const SoftBodyOptions& options)
      : character(std::make_shared<const Character>(std::move(from))) {
    Result<TornModel> made = TornModel::create(character);
    EXPECT_TRUE(made) << made.error().text();
    model = std::make_unique<TornModel>(std::move(*made));
    pose = *bind_pose(*character);
    DecompositionOptions decomposition;
    decomposition.range = range;
    Result<ParticleSet> divided = ParticleSet::create(*model, pose, decomposition);
    EXPECT_TRUE(divided) << divided.error().text();
    set = std::make_unique<ParticleSet>(std::move(*divided));
    Result<SoftBody> soft = SoftBody::create(*set, pose, materials, options);
    EXPECT_TRUE(soft) << soft.error().text();
    body = std::make_unique<SoftBody>(std::move(*soft));
  }

  void step(double seconds) {
    const Status status = body->step(*model, pose, seconds);
    EXPECT_TRUE(status) << status.text();
  }
  void run(double seconds, double step_seconds = 1.0 / 60) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds / step_seconds)); ++i)
      step(step_seconds);
  }
  [[nodiscard]] std::uint32_t count() const { return body->particle_count(); }
  [[nodiscard]] double farthest() const {
    double most = 0;
    for (std::uint32_t p = 0; p < count(); ++p) most = std::max(most, body->displacement(p).norm());
    return most;
  }
  /// The particle whose rest is nearest to a place.
  [[nodiscard]] std::uint32_t nearest(const Vec3d& place) const {
    std::uint32_t best = 0;
    for (std::uint32_t p = 0; p < count(); ++p)
      if ((body->place(p) - place).squaredNorm() < (body->place(best) - place).squaredNorm())
        best = p;
    return best;
  }
};

/// The rest pose with all bones moved together.
inline ModelPose moved(const ModelPose& pose, const Affine3d& model_from_model) {
  ModelPose result = pose;
  for (Affine3d& bone : result.model_from_bone) bone = model_from_model * bone;
  return result;
}

inline Affine3d shift_by(const Vec3d& by) {
  Affine3d affine = Affine3d::Identity();
  affine.translation() = by;
  return affine;
}

inline Affine3d turn_by(double angle, const Vec3d& axis) {
  Affine3d affine = Affine3d::Identity();
  affine.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d(axis)).toRotationMatrix();
  return affine;
}

}  // namespace sunder::test
