#include <sunder/particles/bullet_body.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include "particles/frequency_of.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

constexpr double kStep = 1.0 / 60;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A world that exposes its actions.
class CountedWorld final : public btDiscreteDynamicsWorld {
 public:
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;
  [[nodiscard]] int actions() const { return m_actions.size(); }
};

/// A world, a model divided into particles, and bodies for them.
class BulletBodyTest : public testing::Test {
 protected:
  BulletBodyTest() { world_.setGravity({0, 0, -10}); }
  ~BulletBodyTest() override {
    body_.reset();
    for (const auto& body : bodies_)
      if (body->isInWorld()) world_.removeRigidBody(body.get());
  }

  void load(Character character, double range = 0.1) {
    character_ = std::make_shared<const Character>(std::move(character));
    model_.emplace(std::move(*TornModel::create(character_)));
    set_.emplace(decompose(range));
    pose_ = *bind_pose(*character_);
  }

  [[nodiscard]] ParticleSet decompose(double range) const {
    auto set = ParticleSet::create(*model_, *bind_pose(*character_), {.range = range});
    EXPECT_TRUE(set) << set.error().text();
    return std::move(*set);
  }

  void create(const BulletBodyOptions& options = {},
              const Affine3d& world_from_model = Affine3d::Identity()) {
    auto body = BulletBody::create(*set_, world_, pose_, options, world_from_model);
    ASSERT_TRUE(body) << body.error().text();
    body_.emplace(std::move(*body));
  }

  void step(double seconds = kStep, double substep = kStep) {
    const Status status = body_->before_step(*set_, pose_, seconds);
    ASSERT_TRUE(status) << status.text();
    world_.stepSimulation(static_cast<float>(seconds), 10, static_cast<float>(substep));
    body_->after_step();
  }

  void run(
      int steps, const std::function<void()>& each = [] {}) {
    for (int i = 0; i < steps; ++i) {
      step();
      each();
    }
  }

  btRigidBody& add(btCollisionShape* shape, float mass, const btVector3& place) {
    shapes_.emplace_back(shape);
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
    info.m_startWorldTransform.setOrigin(place);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(bodies_.back().get());
    return *bodies_.back();
  }

  void pull(std::uint32_t particle, const Vec3d& by) {
    btRigidBody& body = body_->body(particle);
    btTransform transform = body.getWorldTransform();
    transform.getOrigin() += btVector3(static_cast<float>(by.x()), static_cast<float>(by.y()),
                                       static_cast<float>(by.z()));
    body.setWorldTransform(transform);
    body.setInterpolationWorldTransform(transform);
    body.activate(true);
  }

  [[nodiscard]] std::vector<ParticleRest> rests() const {
    std::vector<std::uint32_t> all(set_->particle_count());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<ParticleRest> rests(all.size());
    EXPECT_TRUE(set_->rest(pose_, all, rests));
    return rests;
  }

  [[nodiscard]] std::uint32_t particle_next_to(const Vec3d& place) const {
    const auto all = rests();
    std::uint32_t best = 0;
    for (std::uint32_t i = 0; i < all.size(); ++i)
      if ((all[i].place - place).norm() < (all[best].place - place).norm()) best = i;
    return best;
  }

  [[nodiscard]] Vec3d place(std::uint32_t particle) const {
    const btVector3& at = body_->body(particle).getWorldTransform().getOrigin();
    return {double{at.x()}, double{at.y()}, double{at.z()}};
  }

  [[nodiscard]] double most_displacement() const {
    double most = 0;
    for (const Vec4f& u : body_->displacements()) {
      if (!u.allFinite()) return std::numeric_limits<double>::infinity();
      most = std::max(most, double{u.norm()});
    }
    return most;
  }

  [[nodiscard]] int awake() const {
    int count = 0;
    for (std::uint32_t i = 0; i < body_->particle_count(); ++i)
      count += body_->body(i).isActive() ? 1 : 0;
    return count;
  }

  void bend(double angle) {
    Pose pose = *local_rest_pose(*character_);
    for (std::size_t bone = 1; bone < pose.parent_from_bone.size(); ++bone)
      pose.parent_from_bone[bone].rotation =
          Quatf(Eigen::AngleAxisf(static_cast<float>(angle), Eigen::Vector3f::UnitX()));
    ASSERT_TRUE(compute_model_pose(character_->skeleton, pose, pose_));
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  CountedWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::shared_ptr<const Character> character_;
  std::optional<TornModel> model_;
  std::optional<ParticleSet> set_;
  ModelPose pose_;
  std::optional<BulletBody> body_;
};

TEST_F(BulletBodyTest, rest_stays_at_rest_in_every_pose) {
  load(test::make_tube(12, 12, 3));
  for (const double angle : {0.0, 0.7}) {
    bend(angle);
    create();
    ASSERT_EQ(body_->particle_count(), set_->particle_count());
    ASSERT_EQ(body_->displacements().size(), set_->particle_count());
    run(30, [&] { ASSERT_LT(most_displacement(), 1e-5); });
    const auto rest = rests();
    for (std::uint32_t i = 0; i < rest.size(); ++i)
      EXPECT_LT((place(i) - rest[i].place).norm(), 1e-5);
  }
}

TEST_F(BulletBodyTest, a_pulled_particle_swings_as_it_must) {
  load(test::make_sheet(10));
  constexpr double kHertz = 2;
  constexpr double kFrequency = 2 * std::numbers::pi * kHertz;
  for (const double damping : {0.0, 0.05, 0.2})
    for (const double substep : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
      create({.return_frequency = kHertz, .damping_ratio = damping, .neighbour_stiffness = 0});
      const std::uint32_t pulled = particle_next_to({0.5, 0.5, 0});
      pull(pulled, {0, 0, 0.1});
      // The time at which it passes through rest, and the extreme displacement between two passes.
      std::vector<double> crossings, peaks;
      double before = 0.1, before_that = 0.1, most = 0;
      for (int i = 1; i * substep < 2; ++i) {
        step(substep, substep);
        const double now = double{body_->displacements()[pulled].z()};
        if (std::abs(before) > std::abs(now) &&
            std::abs(before) >= std::abs(before_that)) {  // the parabola through three places
          const double bent = before_that - 2 * before + now, slope = (now - before_that) / 2;
          most = std::abs(before - (bent != 0 ? slope * slope / (2 * bent) : 0));
        }
        if ((before > 0) != (now > 0)) {
          crossings.push_back((i - 1 + before / (before - now)) * substep);
          peaks.push_back(most);
        }
        before_that = before;
        before = now;
      }
      ASSERT_GE(crossings.size(), 6u);
      const double half_period = (crossings[5] - crossings[1]) / 4;
      const double damped = kFrequency * std::sqrt(1 - damping * damping);
      EXPECT_NEAR(half_period * damped / std::numbers::pi, 1, 0.01) << damping << ' ' << substep;
      EXPECT_NEAR(std::log(peaks[1] / peaks[4]) / 3,
                  damping * kFrequency * std::numbers::pi / damped, 0.02)
          << damping << ' ' << substep;
      for (std::uint32_t i = 0; i < set_->particle_count(); ++i)
        ASSERT_LT(i == pulled ? 0 : body_->displacements()[i].norm(), 1e-5f);
    }
}

TEST_F(BulletBodyTest, neighbours_come_along) {
  load(test::make_sheet(10));
  create(
      {.return_frequency = test::frequency_of(100), .damping_ratio = 1, .neighbour_stiffness = 80});
  const std::uint32_t held = particle_next_to({0.5, 0.5, 0});
  btRigidBody& hand = body_->body(held);
  world_.removeRigidBody(&hand);  // as a host makes a body kinematic
  hand.setMassProps(0, {0, 0, 0});
  hand.setCollisionFlags(hand.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  world_.addRigidBody(&hand, 64, -1 ^ 64);
  pull(held, {0, 0, 0.2});
  run(300);
  EXPECT_NEAR(body_->displacements()[held].z(), 0.2f, 1e-5f);
  // At rest each particle is where its springs balance.
  const auto u = body_->displacements();
  for (std::uint32_t i = 0; i < set_->particle_count(); ++i) {
    if (i == held) continue;
    double force = -100 * double{u[i].z()}, scale = 1;  // where bodies sleep near rest
    for (const ParticleNeighbour& neighbour : set_->neighbours(i)) {
      const double pulled = 80 * neighbour.coupling * double{u[neighbour.particle].z() - u[i].z()};
      force += pulled;
      scale += std::abs(pulled);
    }
    EXPECT_LT(std::abs(force), 0.15 * scale) << i;
  }
  EXPECT_GT(u[set_->neighbours(held)[0].particle].z(), 0.002f);
}

TEST_F(BulletBodyTest, springs_of_any_stiffness_stay_bounded) {
  load(test::make_sheet(16));
  test::Random random(3);
  for (const double stiffness : {1e2, 1e4, 1e8, 1e16})
    for (const double neighbour : {0.0, 1e4, 1e8, 1e16})
      for (const double damping : {0.0, 0.1, 1.0, 10.0}) {
        create({.return_frequency = test::frequency_of(stiffness),
                .damping_ratio = damping,
                .neighbour_stiffness = neighbour});
        for (std::uint32_t i = 0; i < set_->particle_count(); ++i)
          pull(i, 0.05 * random.direction());
        double worst = 0, last = 0;
        run(240, [&] { worst = std::max(worst, last = most_displacement()); });
        ASSERT_LT(worst, 0.5) << stiffness << ' ' << neighbour << ' ' << damping;
        const bool is_over = damping >= 0.1 && damping <= 1 && stiffness >= 1e4;
        EXPECT_LT(is_over ? last : 0, 1e-3) << stiffness << ' ' << neighbour << ' ' << damping;
      }
}

TEST_F(BulletBodyTest, an_obstacle_pushes_particles_and_they_return_without_it) {
  load(test::make_sheet(12));
  create({.radius = 0.2});
  constexpr double kRadius = 0.3;
  btRigidBody& obstacle =
      add(new btSphereShape(static_cast<float>(kRadius)), 0, {0.5f, 0.5f, -0.2f});
  run(120);
  const double size = 0.2 * set_->range(0);
  EXPECT_GT(most_displacement(), 0.05);
  for (std::uint32_t i = 0; i < set_->particle_count(); ++i)
    EXPECT_GT((place(i) - Vec3d(0.5, 0.5, -0.2)).norm(), kRadius + size - 0.01);
  world_.removeRigidBody(&obstacle);
  for (std::uint32_t i = 0; i < set_->particle_count(); ++i) body_->body(i).activate();
  run(240);
  EXPECT_LT(most_displacement(), 1e-3);
}

TEST_F(BulletBodyTest, a_ball_that_falls_is_carried_by_the_springs) {
  load(test::make_sheet(20));
  // Spheres that Bullet separates by the last bit have no contact in the next substep, and the
  // bodies on them fall slightly.
  world_.getSolverInfo().m_linearSlop = 1e-3f;
  constexpr double kBall = 0.5, kStiffness = 200, kMass = 0.1;
  create({.return_frequency = test::frequency_of(kStiffness),
          .damping_ratio = 0.3,
          .neighbour_stiffness = 100,
          .mass = kMass,
          .radius = 0.25});
  btRigidBody& ball = add(new btSphereShape(0.25f), static_cast<float>(kBall), {0.5f, 0.5f, 0.6f});
  ball.setAngularFactor(0);  // so that it does not roll off
  double fastest = 0;
  run(60, [&] { fastest = std::min(fastest, double{ball.getLinearVelocity().z()}); });
  EXPECT_LT(fastest, -1.5);
  run(540);
  EXPECT_LT(ball.getLinearVelocity().length(), 0.02f);
  EXPECT_GT(ball.getWorldTransform().getOrigin().z(), 0.0f);
  // In balance: forces between pairs cancel, so the sum of the return springs' forces is the weight
  // of the ball.
  double given = 0;
  for (const Vec4f& u : body_->displacements()) given -= kMass * kStiffness * double{u.z()};
  EXPECT_NEAR(given, 10 * kBall, 0.05 * 10 * kBall);
  // When nothing moves, all sleep; ball and particles wake together.
  run(600);
  EXPECT_EQ(awake(), 0);
  EXPECT_FALSE(ball.isActive());
  ball.activate();
  ball.setLinearVelocity({0, 0, 3});
  run(20);
  EXPECT_GT(awake(), 0);
  EXPECT_GT(ball.getWorldTransform().getOrigin().z(), 0.3f);
}

TEST_F(BulletBodyTest, particles_do_not_collide_with_one_another) {
  load(test::make_sheet(12));
  create({.radius = 1.5});
  run(30);
  EXPECT_EQ(dispatcher_.getNumManifolds(), 0);
  EXPECT_LT(most_displacement(), 1e-5);
}

TEST_F(BulletBodyTest, particles_sleep_and_wake_when_the_pose_moves) {
  load(test::make_tube(12, 12, 3));
  create();
  run(150);
  EXPECT_EQ(awake(), 0);
  pull(3, {0.2, 0, 0});
  run(20);
  EXPECT_GT(awake(), 1);  // with its neighbours
  run(600);
  EXPECT_EQ(awake(), 0);
  EXPECT_LT(most_displacement(), 5e-3 * set_->range(0)) << "before";
  bend(0.3);
  step();
  step();
  EXPECT_GT(awake(), static_cast<int>(set_->particle_count()) / 2);
  run(600);
  EXPECT_EQ(awake(), 0);
  EXPECT_LT(most_displacement(), 5e-3 * set_->range(0));
}

TEST_F(BulletBodyTest, a_model_that_is_carried_along_lags_only_while_it_speeds_up) {
  load(test::make_sheet(10));
  for (const double seconds : {1.0 / 60, 1.0 / 144, 1.0 / 25}) {
    create({.return_frequency = test::frequency_of(400), .damping_ratio = 0.7});
    Affine3d world_from_model = Affine3d::Identity();
    double most = 0;
    for (int i = 0; i * seconds < 3; ++i) {
      world_from_model.translation().x() += 2 * seconds;
      ASSERT_TRUE(body_->before_step(*set_, pose_, seconds, world_from_model));
      world_.stepSimulation(static_cast<float>(seconds), 10, static_cast<float>(kStep));
      body_->after_step();
      most = std::max(most, most_displacement());
    }
    EXPECT_GT(most, 0.02) << seconds;
    EXPECT_LT(most, 0.1) << seconds;
    EXPECT_LT(most_displacement(), seconds == kStep ? 1e-4 : 0.02) << seconds;
  }
}

TEST_F(BulletBodyTest, a_model_that_is_put_elsewhere_takes_displacements_along) {
  load(test::make_sheet(10));
  create({.return_frequency = test::frequency_of(400), .damping_ratio = 0.1});
  const std::uint32_t pulled = particle_next_to({0.5, 0.5, 0});
  pull(pulled, {0, 0.1, 0});
  run(3);
  const std::vector<Vec4f> before(body_->displacements().begin(), body_->displacements().end());
  const btVector3 velocity = body_->body(pulled).getLinearVelocity();
  Affine3d world_from_model = Affine3d::Identity();
  world_from_model.translation() = Vec3d(5, 6, 7);
  world_from_model.rotate(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  ASSERT_TRUE(body_->before_step(*set_, pose_, 0, world_from_model));
  for (std::uint32_t i = 0; i < before.size(); ++i)
    EXPECT_LT((body_->displacements()[i] - before[i]).norm(), 1e-5f);
  const Vec3d rest = world_from_model * rests()[pulled].place;
  EXPECT_NEAR((place(pulled) - rest).x(), double{-before[pulled].y()}, 1e-5);
  EXPECT_NEAR(body_->body(pulled).getLinearVelocity().x(), -velocity.y(), 1e-4f);
  run(600);
  EXPECT_LT(most_displacement(), 1e-3);
  EXPECT_LT((place(pulled) - rest).norm(), 1e-3);
}

TEST_F(BulletBodyTest, two_calls_before_a_step_equal_one) {
  load(test::make_sheet(10));
  std::vector<Vec4f> once;
  for (const int times : {1, 3}) {
    create();
    pull(2, {0, 0, 0.1});
    for (int i = 0; i < 10; ++i) {
      for (int k = 1; k < times; ++k) ASSERT_TRUE(body_->before_step(*set_, pose_, 0));
      step();
    }
    if (times == 1) once.assign(body_->displacements().begin(), body_->displacements().end());
  }
  for (std::uint32_t i = 0; i < once.size(); ++i)
    EXPECT_LT((body_->displacements()[i] - once[i]).norm(), 1e-5f);
}

TEST_F(BulletBodyTest, weight_sags) {
  load(test::make_sheet(10));
  create({.return_frequency = test::frequency_of(100), .damping_ratio = 0.7, .weight = 0.5});
  run(300);
  for (const Vec4f& u : body_->displacements()) EXPECT_NEAR(u.z(), -0.05f, 0.002f);
}

TEST_F(BulletBodyTest, bodies_follow_the_set) {
  load(test::make_sheet(12));
  create();
  pull(0, {0, 0, 0.1});
  run(2);
  const Vec3d at = place(0), rest = rests()[0].place;
  const Vec4f displaced = body_->displacements()[0];
  const btRigidBody* const first = &body_->body(0);
  // Another set of particles, in which those with known serial numbers stay.
  const std::uint32_t count = set_->particle_count();
  ParticleSet coarse = decompose(0.2);
  ASSERT_LT(coarse.particle_count(), count);
  std::swap(*set_, coarse);
  ASSERT_TRUE(body_->before_step(*set_, pose_, 0));
  EXPECT_EQ(body_->particle_count(), set_->particle_count());
  EXPECT_EQ(world_.getNumCollisionObjects(), static_cast<int>(set_->particle_count()));
  EXPECT_EQ(&body_->body(0), first);
  EXPECT_LT((body_->displacements()[0] - displaced).norm(),
            1e-5f);  // although its rest is elsewhere
  EXPECT_LT((place(0) - at - (rests()[0].place - rest)).norm(), 1e-5);
  std::swap(*set_, coarse);
  ASSERT_TRUE(body_->before_step(*set_, pose_, kStep));
  EXPECT_EQ(world_.getNumCollisionObjects(), static_cast<int>(count));
  EXPECT_LT((body_->displacements()[0] - displaced).norm(), 1e-5f);
  EXPECT_LT((place(0) - at).norm(), 1e-5);
  for (std::uint32_t i = 0; i < count; ++i)
    EXPECT_EQ(body_->body(i).getUserIndex(), static_cast<int>(i));
  run(300);
  EXPECT_LT(most_displacement(), 1e-3);
}

TEST_F(BulletBodyTest, nothing_stays_in_the_world) {
  load(test::make_sheet(10));
  add(new btStaticPlaneShape({0, 0, 1}, 0), 0, {0, 0, -0.05f});
  create();
  ASSERT_EQ(world_.getNumCollisionObjects(), static_cast<int>(set_->particle_count()) + 1);
  EXPECT_EQ(world_.actions(), 1);
  btPoint2PointConstraint hand(body_->body(1), btVector3(0, 0, 0));
  world_.addConstraint(&hand);
  run(5);

  BulletBody moved = std::move(*body_);
  EXPECT_EQ(world_.actions(), 1);
  auto other = BulletBody::create(*set_, world_, pose_);
  ASSERT_TRUE(other);
  EXPECT_EQ(world_.actions(), 2);
  *other = std::move(moved);  // the former contents of `other` are gone
  EXPECT_EQ(world_.actions(), 1);
  EXPECT_EQ(world_.getNumCollisionObjects(), static_cast<int>(set_->particle_count()) + 1);
  body_.emplace(std::move(*other));
  run(5);

  body_.reset();
  EXPECT_EQ(world_.actions(), 0);
  EXPECT_EQ(world_.getNumCollisionObjects(), 1);
  EXPECT_EQ(world_.getNumConstraints(), 0);
  EXPECT_EQ(dispatcher_.getNumManifolds(), 0);
  world_.stepSimulation(0.1f, 10);
}

TEST_F(BulletBodyTest, bad_arguments_are_refused_by_name) {
  load(test::make_sheet(4));
  const auto refused = [&](const BulletBodyOptions& options, std::string_view name) {
    const auto body = BulletBody::create(*set_, world_, pose_, options);
    ASSERT_FALSE(body) << name;
    EXPECT_EQ(body.error().code(), StatusCode::invalid_argument);
    EXPECT_NE(body.error().text().find(name), std::string_view::npos) << body.error().text();
  };
  for (const double bad : {-1.0, kNaN}) {
    refused({.return_frequency = bad}, "return_frequency");
    refused({.damping_ratio = bad}, "damping_ratio");
    refused({.neighbour_stiffness = bad}, "neighbour_stiffness");
    refused({.mass = bad}, "mass");
    refused({.radius = bad}, "radius");
    refused({.friction = bad}, "friction");
    refused({.weight = bad}, "weight");
  }
  refused({.damping_ratio = 11}, "damping_ratio");
  refused({.mass = 0}, "mass");
  refused({.collision_group = 0}, "collision_group");

  Affine3d placed = Affine3d::Identity();
  placed.linear()(2, 2) = -1;
  EXPECT_EQ(BulletBody::create(*set_, world_, pose_, {}, placed).error().code(),
            StatusCode::invalid_argument);
  placed.linear()(2, 2) = kNaN;
  EXPECT_EQ(BulletBody::create(*set_, world_, pose_, {}, placed).error().code(),
            StatusCode::non_finite_value);
  ModelPose other = pose_;
  other.model_from_bone.pop_back();
  EXPECT_EQ(BulletBody::create(*set_, world_, other).error().code(), StatusCode::size_mismatch);
  EXPECT_EQ(world_.getNumCollisionObjects(), 0);
  EXPECT_EQ(world_.actions(), 0);

  create();
  EXPECT_EQ(body_->before_step(*set_, other, kStep).code(), StatusCode::size_mismatch);
  EXPECT_EQ(body_->before_step(*set_, pose_, -1).code(), StatusCode::invalid_argument);
  EXPECT_EQ(body_->before_step(*set_, pose_, kNaN).code(), StatusCode::invalid_argument);
  EXPECT_EQ(body_->before_step(*set_, pose_, kStep, placed).code(), StatusCode::non_finite_value);
  run(5);
  EXPECT_LT(most_displacement(), 1e-5);
}

TEST_F(BulletBodyTest, follows_tears_and_their_undo) {
  load(test::make_sheet(20));
  create();
  run(3);
  const std::uint32_t before = set_->particle_count();
  const std::array stroke = {test::down_at(0.2, 0.5), test::down_at(0.8, 0.5)};
  ChangeRecord change;
  ASSERT_TRUE(model_->tear(pose_, stroke, {}, &change));
  ASSERT_TRUE(set_->follow(*model_, {&change, 1}));
  while (set_->settle(*model_)) {
  }
  run(5);
  ASSERT_EQ(body_->particle_count(), set_->particle_count());
  ASSERT_EQ(body_->displacements().size(), set_->particle_count());
  for (const Vec4f& displacement : body_->displacements()) EXPECT_LT(displacement.norm(), 1e-4f);

  // One lip is pulled: it moves, the other does not.
  const LipPair& middle = change.lips[change.lips.size() / 2];
  const auto displaced = [&](std::uint32_t point) {
    const ParticleInfluences& of = set_->influences()[point];
    Vec4f sum = Vec4f::Zero();
    for (std::size_t i = 0; i < 4; ++i)
      sum += of.weights[i] * body_->displacements()[of.particles[i]];
    return sum.norm();
  };
  pull(set_->influences()[middle.left].particles[0], {0, 0.02, 0.05});
  run(2);
  EXPECT_GT(displaced(middle.left), 0.005f);
  EXPECT_LT(displaced(middle.right), 0.3f * displaced(middle.left));

  ASSERT_TRUE(model_->undo(&change));
  ASSERT_TRUE(set_->follow(*model_, {&change, 1}));
  run(5);
  EXPECT_EQ(body_->particle_count(), before);
  EXPECT_EQ(static_cast<std::uint32_t>(world_.getNumCollisionObjects()), before);
}

}  // namespace
}  // namespace sunder
