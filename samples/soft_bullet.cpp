// A soft, posed sheet in a Bullet world catches a falling ball. The engine owns the world and the
// ball; the particles of the sheet are bodies like any other.

#include <sunder/particles/bullet_body.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

namespace {

/// A square metre in the plane z = 0, on two bones along x.
std::shared_ptr<const sunder::Character> make_sheet() {
  constexpr std::uint32_t kCells = 24;
  auto character = std::make_shared<sunder::Character>();
  character->skeleton.bones.push_back({"left", sunder::kNone, {}});
  sunder::Bone right{"right", 0, {}};
  right.rest.translation = {0.5f, 0.0f, 0.0f};
  character->skeleton.bones.push_back(right);
  sunder::Skin skin{
      "sheet", {0, 1}, std::vector<sunder::Affine3f>(2, sunder::Affine3f::Identity())};
  skin.bone_from_bind[1].translation() = Eigen::Vector3f(-0.5f, 0.0f, 0.0f);
  character->skins.push_back(skin);
  sunder::Mesh mesh;
  mesh.name = "sheet";
  mesh.submeshes.push_back({"cloth", sunder::kNone});
  for (std::uint32_t j = 0; j <= kCells; ++j)
    for (std::uint32_t i = 0; i <= kCells; ++i) {
      const float x = static_cast<float>(i) / kCells, y = static_cast<float>(j) / kCells;
      mesh.positions.emplace_back(x, y, 0.0f);
      const float forward = std::clamp(2.0f * x - 0.5f, 0.0f, 1.0f);
      const sunder::Influence both[] = {{0, 1.0f - forward}, {1, forward}};
      mesh.weights.append(forward <= 0.0f   ? std::span<const sunder::Influence>(both, 1)
                          : forward >= 1.0f ? std::span<const sunder::Influence>(both + 1, 1)
                                            : std::span<const sunder::Influence>(both));
      if (i == kCells || j == kCells) continue;
      const std::uint32_t a = j * (kCells + 1) + i, b = a + 1, c = a + kCells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  character->meshes.push_back(mesh);
  return character;
}

/// Lifts both sides, which makes a trough along y.
sunder::ModelPose lifted(const sunder::Character& character, float angle) {
  sunder::Pose pose;
  for (const sunder::Bone& bone : character.skeleton.bones)
    pose.parent_from_bone.push_back(bone.rest);
  pose.parent_from_bone[0].rotation =
      sunder::Quatf(Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitY()));
  pose.parent_from_bone[1].rotation =
      sunder::Quatf(Eigen::AngleAxisf(-2 * angle, Eigen::Vector3f::UnitY()));
  sunder::ModelPose posed;
  (void)sunder::compute_model_pose(character.skeleton, pose, posed);
  return posed;
}

/// Lets the ball fall into the soft sheet for ten seconds.
/// @return the largest displacement of the sheet, metres.
sunder::Result<float> catch_ball(const sunder::Character& sheet, const sunder::ParticleSet& set,
                                 const btRigidBody& ball, btDiscreteDynamicsWorld& world) {
  sunder::BulletBodyOptions options;
  options.return_frequency = 2.75;
  options.neighbour_stiffness = 80;
  options.mass = 0.05;
  options.radius = 0.4;
  float angle = 0.2f;
  auto soft = sunder::BulletBody::create(set, world, lifted(sheet, angle), options);
  if (!soft) return soft.error();
  std::printf("%u particles\n", soft->particle_count());

  constexpr float kFrame = 1.0f / 60;
  float deepest = 0;
  for (int frame = 0; frame < 600; ++frame) {
    angle = std::min(0.35f, angle + 0.1f * kFrame);  // the animation goes on
    if (const auto status = soft->before_step(set, lifted(sheet, angle), double{kFrame}); !status)
      return status;
    world.stepSimulation(kFrame, 4);
    soft->after_step();
    float most = 0;
    for (const sunder::Vec4f& u : soft->displacements())
      most = std::max(most, u.norm());  // to the GPU, or SkinnedMesh
    deepest = std::max(deepest, most);
    if (frame % 60 != 59) continue;
    const btVector3& at = ball.getWorldTransform().getOrigin();
    std::printf("%2d s: ball at (%.2f, %.2f, %.2f) m, sheet gives way by %.0f mm\n",
                (frame + 1) / 60, double{at.x()}, double{at.y()}, double{at.z()},
                double{1e3f * most});
  }
  return deepest;
}

int fail(const sunder::Status& status) { return std::printf("%s\n", status.text().data()), 1; }

}  // namespace

int main() {
  // The world of an engine, with a body in it.
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0, 0, -9.81f});
  world.getSolverInfo().m_linearSlop = 1e-3f;  // lets a body come to rest on spheres
  constexpr float kRadius = 0.2f;
  btSphereShape shape(kRadius);
  btVector3 inertia;
  shape.calculateLocalInertia(0.5f, inertia);
  btRigidBody ball(btRigidBody::btRigidBodyConstructionInfo(0.5f, nullptr, &shape, inertia));
  ball.setWorldTransform(btTransform(btQuaternion::getIdentity(), {0.48f, 0.5f, 0.6f}));
  ball.setDamping(0.0f, 0.2f);
  ball.setRollingFriction(0.05f);
  world.addRigidBody(&ball);

  const auto sheet = make_sheet();
  const auto model = sunder::TornModel::create(sheet);
  if (!model) return fail(model.error());
  const auto bind = sunder::bind_pose(*sheet);
  if (!bind) return fail(bind.error());
  const auto set = sunder::ParticleSet::create(*model, *bind, {.range = 0.08});
  if (!set) return fail(set.error());
  const auto deepest = catch_ball(*sheet, *set, ball, world);
  if (!deepest) return fail(deepest.error());

  const btVector3& at = ball.getWorldTransform().getOrigin();
  const bool is_held =
      at.z() > -0.3f && ball.getLinearVelocity().length() < 0.05f && at.x() > 0.2f && at.x() < 0.8f;
  const bool has_sagged = *deepest > 0.02f;
  const bool is_gone = world.getNumCollisionObjects() == 1;
  world.removeRigidBody(&ball);
  std::printf("the ball %s, the sheet %s, the world %s\n", is_held ? "is held" : "fell",
              has_sagged ? "gave way" : "did not give way",
              is_gone ? "is as it was" : "keeps particles");
  return is_held && has_sagged && is_gone ? 0 : 1;
}
