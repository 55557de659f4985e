// A ball on a stick is pressed into a soft tube that bends, held there, and taken away.

#include <sunder/particles/soft_body.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <vector>

namespace {

constexpr std::uint32_t kAround = 32, kAlong = 60;
constexpr float kRadius = 0.15f, kLength = 1.0f;
constexpr double kFrame = 1.0 / 60, kBall = 0.08;

/// A tube of one metre on two bones, one joint in its middle.
sunder::Character make_tube() {
  sunder::Character character;
  sunder::BoneTransform at_elbow;
  at_elbow.translation = {0, kLength / 2, 0};
  character.skeleton.bones = {{"lower", sunder::kNone, {}}, {"upper", 0, at_elbow}};
  sunder::Affine3f upper_from_bind = sunder::Affine3f::Identity();
  upper_from_bind.translation() = -at_elbow.translation;
  character.skins = {{"Tube", {0, 1}, {sunder::Affine3f::Identity(), upper_from_bind}}};

  sunder::Mesh mesh;
  mesh.name = "Tube";
  for (std::uint32_t ring = 0; ring <= kAlong; ++ring)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kAround;
      const float height = kLength * static_cast<float>(ring) / kAlong;
      mesh.positions.emplace_back(kRadius * std::sin(angle), height, kRadius * std::cos(angle));
      const float upper = std::clamp((height - 0.4f) / 0.2f, 0.0f, 1.0f);
      const sunder::Influence both[] = {{0, 1.0f - upper}, {1, upper}};
      if (upper == 0.0f)
        mesh.weights.append({both, 1});
      else if (upper == 1.0f)
        mesh.weights.append({both + 1, 1});
      else
        mesh.weights.append(both);
    }
  for (std::uint32_t ring = 0; ring < kAlong; ++ring)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const std::uint32_t a = ring * kAround + i, b = ring * kAround + (i + 1) % kAround,
                          c = a + kAround, d = b + kAround;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  mesh.submeshes.push_back({"Flesh", sunder::kNone});
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  character.meshes = {mesh};
  return character;
}

/// The tube bent by an angle at its joint.
sunder::ModelPose bent(const sunder::Character& character, double angle) {
  sunder::Pose pose = local_rest_pose(character);
  pose.parent_from_bone[1].rotation =
      sunder::Quatf(Eigen::AngleAxisf(static_cast<float>(angle), Eigen::Vector3f::UnitX()));
  sunder::ModelPose model_pose;
  if (!compute_model_pose(character.skeleton, pose, model_pose)) std::abort();
  return model_pose;
}

double deepest_dent(sunder::SoftBody& body) {
  double most = 0;
  for (const sunder::Vec4f& d : body.displacements())
    most = std::max(most, double{d.head<3>().norm()});
  return most;
}

int fail(const char* what, const sunder::Status& status) {
  std::printf("%s: %s\n", what, status.text().data());
  return 1;
}

}  // namespace

int main() {
  const auto character = std::make_shared<const sunder::Character>(make_tube());
  auto model = sunder::TornModel::create(character);
  if (!model) return fail("create", model.error());

  const sunder::SoftMaterial flesh = sunder::find_material("fat").value();
  const sunder::ModelPose straight = bent(*character, 0);
  sunder::DecompositionOptions division;
  division.range = flesh.range / 2;
  auto particles = sunder::ParticleSet::create(*model, straight, division);
  if (!particles) return fail("decompose", particles.error());
  auto body = sunder::SoftBody::create(*particles, straight, {&flesh, 1});
  if (!body) return fail("soft body", body.error());

  const sunder::Collider ball = {
      sunder::Collider::Sphere{kBall}, {0, 0.25, 0.4}, sunder::Quatd::Identity(), 0.3};
  if (const sunder::Status status = body->set_colliders({&ball, 1}); !status)
    return fail("colliders", status);
  const auto frame = [&](double angle, double distance) {
    (void)body->move_collider(0, {0, 0.25, distance}, sunder::Quatd::Identity());
    return body->step(*model, bent(*character, angle), kFrame);
  };

  // In by six centimetres within a second, while the tube bends; held for a second; out again.
  const double touches = double{kRadius} + kBall, far = touches + 0.1, near = touches - 0.06;
  double angle = 0, dent = 0, left_inside = 0;
  std::uint32_t most_awake = 0;
  for (int i = 1; i <= 180; ++i) {
    const double in = i <= 60 ? i / 60.0 : i <= 120 ? 1.0 : (180 - i) / 60.0;
    angle = 0.6 * std::min(1.0, i / 60.0);
    if (const sunder::Status status = frame(angle, far + in * (near - far)); !status)
      return fail("step", status);
    dent = std::max(dent, deepest_dent(*body));
    left_inside = std::max(left_inside, body->contacts().deepest);
    most_awake = std::max(most_awake, body->awake_count());
  }
  std::printf("the deepest dent: %.1f mm; a contact point was inside the ball by %.2f mm at most\n",
              1e3 * dent, 1e3 * left_inside);
  std::printf("of %u particles at most %u were awake\n", body->particle_count(), most_awake);

  int frames = 0;
  for (; frames < 600 && body->awake_count() > 0; ++frames)
    if (const sunder::Status status = frame(angle, far); !status) return fail("step", status);
  std::printf("it was at rest %.2f s after the ball had gone, %.3g mm from where it was\n",
              frames * kFrame, 1e3 * deepest_dent(*body));

  const bool held = dent > 0.04 && dent < 0.1 && left_inside < 1e-3 && body->awake_count() == 0 &&
                    deepest_dent(*body) == 0;
  std::puts(held ? "the tube gave way and came back" : "the tube did NOT do what it should");
  return held ? 0 : 1;
}
