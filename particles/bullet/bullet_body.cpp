#include <sunder/particles/bullet_body.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

static_assert(sizeof(btScalar) == sizeof(float), "the world of the host has single precision");

namespace sunder {
namespace particles {
namespace {
using Columns = Eigen::Matrix3Xd;

/// Until the first substep tells.
constexpr double kLikelySubstep = 1.0 / 60;
constexpr int kMostIterations = 64;
/// A residual this small a part of the right-hand side is none, both squared.
constexpr double kLeastResidual = 1e-12;
/// Ranges from rest at which a particle that swings, or creeps, is about to sleep.
constexpr double kStill = 2e-3;
/// Times that distance: a change of the springs' pull that wakes, as if the particle had been moved so far.
constexpr double kWakes = 2;

Vec3d to_vec(const btVector3& v) { return {double{v.x()}, double{v.y()}, double{v.z()}}; }
btVector3 to_bullet(const Vec3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

/// A spring over one substep: (1 + damping) v' = v - stiffness x, then x' = x + h v'.
struct Spring {
  double damping = 0;
  double stiffness = 0;  ///< 1/s.
};

/// That which goes exactly through the places of x'' = -f^2 x - 2 d f x', substep after substep: its step has that motion's
/// eigenvalues, exp((-d +- sqrt(d^2 - 1)) f h). Bounded by itself, and in any sum of such springs whose masses are shares of the
/// particle's: h stiffness <= 2 + damping, half of what would grow.
Spring over_substep(double frequency, double damping_ratio, double seconds, double most_decay) {
  const double angle = std::min(frequency * seconds, std::numbers::pi / 2);
  const double decay = std::min(damping_ratio * angle, most_decay);
  const double square = angle * angle - decay * decay;
  const double swing = square >= 0 ? std::cos(std::sqrt(square)) : std::cosh(std::sqrt(-square));
  const double alpha = std::exp(-2 * decay);
  const double beta = std::max(0.0, 1 + alpha - 2 * std::exp(-decay) * swing) / seconds;
  return {(1 - alpha) / alpha, beta / alpha};
}

struct Pair {
  Index a = 0, b = 0;
  double share = 0;      ///< Of the mass of either that this spring moves.
  double frequency = 0;  ///< Of that share, rad/s.
  Spring spring;         ///< Times the share.
};

struct Grain {
  std::unique_ptr<btSphereShape> shape;
  std::unique_ptr<btRigidBody> body;
};

bool is_held(const btRigidBody& body) { return body.getInvMass() <= 0 || body.isStaticOrKinematicObject(); }

void put(btRigidBody& body, const Vec3d& place) {
  btTransform transform = body.getWorldTransform();
  transform.setOrigin(to_bullet(place));
  body.setWorldTransform(transform);
  body.setInterpolationWorldTransform(transform);
}

}  // namespace

class BulletParticles final : public btActionInterface {
 public:
  BulletParticles(btDynamicsWorld& world, const BulletBodyOptions& options, const Affine3d& world_from_model)
      : world_(&world), options_(options), world_from_model_(world_from_model) {}
  ~BulletParticles() override {
    if (is_in_world_) world_->removeAction(this);
    for (Grain& grain : grains_) leave(grain);
  }
  BulletParticles(const BulletParticles&) = delete;
  BulletParticles& operator=(const BulletParticles&) = delete;

  Status create(const ParticleSet& set, const ModelPose& pose) {
    if (Status status = evaluate(set, pose, world_from_model_, new_target_); !status) return status;
    pose_ = pose;
    match(set, new_target_);
    target_ = rest_;
    world_->addAction(this);
    is_in_world_ = true;
    read();
    return {};
  }

  Status before_step(const ParticleSet& set, const ModelPose& pose, double seconds, const Affine3d& world_from_model) {
    if (Status status = evaluate(set, pose, world_from_model, new_target_); !status) return status;
    if (set.revision() != revision_ || set.particle_count() != grains_.size()) {
      if (Status status = evaluate(set, pose_, world_from_model_, old_target_); !status) return status;
      match(set, old_target_);
    }
    pose_ = pose;
    target_ = new_target_;
    if (seconds > 0) {
      remaining_ = seconds + std::min(remaining_, substep_);
    } else {
      jump(world_from_model);
      remaining_ = 0;
    }
    world_from_model_ = world_from_model;
    moves_ = (target_.array() != rest_.array()).any();
    read_gravity();
    pull(substep_);
    read();
    return {};
  }

  void after_step() {
    // stepSimulation() cleared what was left of them.
    given_.setZero();
    read();
  }

  /// Bullet calls this at the end of every substep: what is done here is for the next.
  void updateAction(btCollisionWorld*, btScalar seconds) override {
    substep_ = double{seconds};
    if (!(substep_ > 0)) return;
    if (const double part = part_of_way(substep_); part >= 1) {
      rest_ = target_;
      moves_ = false;
    } else if (part > 0) {
      rest_ += part * (target_ - rest_);
    }
    remaining_ = std::max(0.0, remaining_ - substep_);
    pull(substep_);
  }
  void debugDraw(btIDebugDraw*) override {}

  [[nodiscard]] std::span<const Vec4f> displacements() const { return displacements_; }
  [[nodiscard]] const Affine3d& world_from_model() const { return world_from_model_; }
  [[nodiscard]] Index count() const { return static_cast<Index>(grains_.size()); }
  [[nodiscard]] btRigidBody& body(Index particle) const { return *grains_[particle].body; }

 private:
  /// Rest places in world space, a column a particle.
  Status evaluate(const ParticleSet& set, const ModelPose& pose, const Affine3d& world_from_model, Columns& places) {
    const Index count = set.particle_count();
    if (all_.size() != count) {
      all_.resize(count);
      std::iota(all_.begin(), all_.end(), Index{0});
      rests_.resize(count);
    }
    if (Status status = set.rest(pose, all_, rests_); !status) return status;
    places.resize(3, count);
    for (Index i = 0; i < count; ++i) places.col(i) = world_from_model * rests_[i].place;
    return {};
  }

  /// Of the way to the target: what rest places go in a substep.
  [[nodiscard]] double part_of_way(double seconds) const {
    return remaining_ <= 0 || !moves_ ? 0.0 : seconds < remaining_ ? seconds / remaining_ : 1.0;
  }

  /// Gives the set's particles bodies. @param places  their rest places where target_ has those of the particles until now.
  void match(const ParticleSet& set, const Columns& places) {
    const Index count = set.particle_count();
    const Index old_count = this->count();
    std::unordered_map<std::uint64_t, Index> old_of_serial;
    for (Index i = 0; i < old_count; ++i) old_of_serial.emplace(serials_[i], i);

    Columns displacement = Columns::Zero(3, count), velocity = Columns::Zero(3, count), lag = Columns::Zero(3, count);
    std::vector<std::uint64_t> serials(count);
    std::vector<Index> old_of(count, kNone);
    std::vector<Grain> made(count);
    const auto old_state = [&](Index old, Vec3d& from_rest, Vec3d& speed, Vec3d& behind) {
      from_rest = place_of(old) - rest_.col(old);
      speed = to_vec(body(old).getLinearVelocity());
      behind = target_.col(old) - rest_.col(old);
    };
    const auto set_state = [&](Index i, const Vec3d& from_rest, const Vec3d& speed, const Vec3d& behind) {
      displacement.col(i) = from_rest;
      velocity.col(i) = speed;
      lag.col(i) = behind;
    };
    for (Index i = 0; i < count; ++i) {
      serials[i] = set.serial(i);
      if (const auto old = old_of_serial.find(serials[i]); old != old_of_serial.end()) {
        old_of[i] = old->second;
        Vec3d from_rest, speed, behind;
        old_state(old->second, from_rest, speed, behind);
        set_state(i, from_rest, speed, behind);
      }
    }
    for (Index i = 0; i < count; ++i) {
      if (old_of[i] != kNone) continue;
      // Parents are numbered as before the tear. Of several tears between two calls, the later ones' may be new themselves.
      const ParticleInfluences& parents = set.parents(i);
      Vec3d from_rest = Vec3d::Zero(), speed = Vec3d::Zero(), behind = Vec3d::Zero();
      for (std::size_t k = 0; k < parents.particles.size(); ++k) {
        const double weight = double{parents.weights[k]};
        const Index parent = parents.particles[k];
        if (!(weight > 0) || parent >= std::max(count, old_count)) continue;
        Vec3d of_parent, speed_of_parent, behind_of_parent;
        if (parent < old_count) {
          old_state(parent, of_parent, speed_of_parent, behind_of_parent);
        } else {
          of_parent = displacement.col(parent);
          speed_of_parent = velocity.col(parent);
          behind_of_parent = lag.col(parent);
        }
        from_rest += weight * of_parent;
        speed += weight * speed_of_parent;
        behind += weight * behind_of_parent;
      }
      set_state(i, from_rest, speed, behind);
      made[i] = make(set.range(i));
    }
    std::vector<Pair> pairs = pairs_of(set);
    Columns rest = places - lag, given = Columns::Zero(3, count), balance = Columns::Zero(3, count);
    Columns rest_velocity = Columns::Zero(3, count);
    std::vector<double> still(count);
    for (Index i = 0; i < count; ++i) {
      still[i] = still_speed(set.range(i));
      if (old_of[i] == kNone) continue;
      given.col(i) = given_.col(old_of[i]);
      rest_velocity.col(i) = rest_velocity_.col(old_of[i]);
    }
    for (Columns* columns : {&relative_, &displaced_, &solved_, &residual_, &direction_, &product_})
      *columns = Columns::Zero(3, count);
    diagonal_.resize(count);
    held_.assign(count, 0);
    displacements_.assign(count, Vec4f::Zero());

    // From here on nothing fails but Bullet.
    for (Index i = 0; i < count; ++i)
      if (old_of[i] != kNone) made[i] = std::move(grains_[old_of[i]]);
    for (Grain& grain : grains_)
      if (grain.body) leave(grain);
    grains_ = std::move(made);
    for (Index i = 0; i < count; ++i) {
      btRigidBody& body = *grains_[i].body;
      put(body, rest.col(i) + displacement.col(i));
      body.setUserIndex(static_cast<int>(i));
      if (old_of[i] == kNone) {
        body.setLinearVelocity(to_bullet(velocity.col(i)));
        world_->addRigidBody(&body, options_.collision_group, options_.collision_mask & ~options_.collision_group);
      }
      body.activate(true);
    }
    serials_ = std::move(serials);
    pairs_ = std::move(pairs);
    rest_ = std::move(rest);
    given_ = std::move(given);
    balance_ = std::move(balance);
    rest_velocity_ = std::move(rest_velocity);
    still_ = std::move(still);
    revision_ = set.revision();
    springs_for_ = 0;
  }

  [[nodiscard]] double scale() const { return std::cbrt(world_from_model_.linear().determinant()); }
  [[nodiscard]] double still_speed(double range) const {
    return kStill * range * scale() *
           std::max(1.0, std::sqrt(options_.return_stiffness) / std::max(1.0, 2 * options_.damping_ratio));
  }

  [[nodiscard]] Grain make(double range) const {
    Grain grain;
    grain.shape = std::make_unique<btSphereShape>(static_cast<btScalar>(options_.radius * range * scale()));
    // Without inertia it does not turn.
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(options_.mass), nullptr, grain.shape.get());
    info.m_friction = static_cast<btScalar>(options_.friction);
    info.m_linearSleepingThreshold = static_cast<btScalar>(still_speed(range));
    grain.body = std::make_unique<btRigidBody>(info);
    grain.body->setAngularFactor(0);
    grain.body->setFlags(grain.body->getFlags() | BT_DISABLE_WORLD_GRAVITY);
    return grain;
  }

  /// Takes a body out of the world, with what hangs on it; what lies on it wakes.
  void leave(Grain& grain) {
    btRigidBody* body = grain.body.get();
    if (body == nullptr || !body->isInWorld()) return;
    for (int i = world_->getNumConstraints(); i-- > 0;) {
      btTypedConstraint* constraint = world_->getConstraint(i);
      if (&constraint->getRigidBodyA() != body && &constraint->getRigidBodyB() != body) continue;
      constraint->getRigidBodyA().activate();
      constraint->getRigidBodyB().activate();
      world_->removeConstraint(constraint);
    }
    btDispatcher* dispatcher = world_->getDispatcher();
    for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
      const btPersistentManifold* manifold = dispatcher->getManifoldByIndexInternal(i);
      if (manifold->getBody0() != body && manifold->getBody1() != body) continue;
      manifold->getBody0()->activate();
      manifold->getBody1()->activate();
    }
    world_->removeRigidBody(body);
  }

  [[nodiscard]] std::vector<Pair> pairs_of(const ParticleSet& set) const {
    std::vector<Pair> pairs;
    if (!(options_.neighbour_stiffness > 0)) return pairs;
    std::vector<double> coupled(set.particle_count(), 0.0);
    for (Index a = 0; a < set.particle_count(); ++a)
      for (const ParticleNeighbour& neighbour : set.neighbours(a)) {
        if (neighbour.particle <= a) continue;
        const double coupling = set.coupling(a, neighbour);
        if (!(coupling > 0)) continue;
        pairs.push_back({a, neighbour.particle, coupling, 0, {}});
        coupled[a] += coupling;
        coupled[neighbour.particle] += coupling;
      }
    // Each spring moves a share of the masses that it joins, by its part in what pulls at them: no mass is moved twice, so that
    // the sum of springs is bounded because each is.
    for (Pair& pair : pairs) {
      const double most = std::max(coupled[pair.a], coupled[pair.b]);
      pair.frequency = std::sqrt(2 * options_.neighbour_stiffness * most);
      pair.share = pair.share / (2 * most);
    }
    return pairs;
  }

  void update_springs(double seconds) {
    if (seconds == springs_for_) return;
    springs_for_ = seconds;
    return_spring_ = over_substep(std::sqrt(options_.return_stiffness), options_.damping_ratio, seconds, 16);
    diagonal_.setConstant(1 + return_spring_.damping);
    for (Pair& pair : pairs_) {
      // Damping that is ever so strong would make the system ill-conditioned.
      pair.spring = over_substep(pair.frequency, options_.damping_ratio, seconds, 2);
      pair.spring.damping *= pair.share;
      pair.spring.stiffness *= pair.share;
      diagonal_[pair.a] += pair.spring.damping;
      diagonal_[pair.b] += pair.spring.damping;
    }
    weigh(seconds);
  }

  /// Gives bodies their masses and weights for a substep. What a load presses in is m k u where it rests, and Bullet adds its
  /// impulses after the springs': the body has the mass with which the spring's change of velocity makes that force. An implicit
  /// solver of both together would see about that mass, too.
  void weigh(double seconds) {
    const double k = options_.return_stiffness, beta = return_spring_.stiffness / (1 + return_spring_.damping);
    const double mass = k > 0 && beta > 0 ? options_.mass * k * seconds / beta : options_.mass;
    for (Grain& grain : grains_) {
      if (is_held(*grain.body)) continue;
      grain.body->setMassProps(static_cast<btScalar>(mass), {0, 0, 0});
      if (options_.weight > 0) grain.body->setGravity(to_bullet(options_.mass / mass * gravity_));
    }
  }

  void read_gravity() {
    if (!(options_.weight > 0)) return;
    const Vec3d gravity = options_.weight * to_vec(world_->getGravity());
    if (gravity == gravity_) return;
    gravity_ = gravity;
    springs_for_ = 0;
    for (Grain& grain : grains_) grain.body->activate();
  }

  [[nodiscard]] Vec3d place_of(Index i) const { return to_vec(body(i).getWorldTransform().getOrigin()); }

  /// Puts the model where target_ has it, at once.
  void jump(const Affine3d& world_from_model) {
    const Mat3d turn = world_from_model.linear() * world_from_model_.linear().inverse();
    const bool turns = world_from_model.linear() != world_from_model_.linear();
    if (!turns && target_ == rest_) return;
    for (Index i = 0; i < count(); ++i) {
      btRigidBody& of = body(i);
      const Vec3d velocity = to_vec(of.getLinearVelocity()) - rest_velocity_.col(i);
      put(of, target_.col(i) + turn * (place_of(i) - rest_.col(i)));
      of.setLinearVelocity(to_bullet(turn * velocity));
      of.activate();
    }
    rest_ = target_;
    rest_velocity_.setZero();
  }

  /// Gives the bodies the forces of the springs in the coming substep, instead of those that they were given last. Forces, and not
  /// velocities, so that Bullet finds a body still that springs hold against a contact.
  void pull(double seconds) {
    const double part = part_of_way(seconds);
    bool is_awake = part > 0;
    for (Index i = 0; i < count() && !is_awake; ++i) is_awake = body(i).isActive();
    if (!is_awake) return;
    update_springs(seconds);
    rest_velocity_ = (part / seconds) * (target_ - rest_);
    for (Index i = 0; i < count(); ++i) {
      const btRigidBody& of = body(i);
      held_[i] = is_held(of) ? 1 : 0;
      displaced_.col(i) = place_of(i) - rest_.col(i);
      relative_.col(i) = to_vec(of.getLinearVelocity()) - rest_velocity_.col(i);
    }
    solve();
    const double wakes = kWakes * std::min(1.0, std::sqrt(options_.return_stiffness) * seconds);
    for (Index i = 0; i < count(); ++i) {
      if (held_[i] != 0) continue;
      btRigidBody& of = body(i);
      const Vec3d change = solved_.col(i) - relative_.col(i);
      if (of.isActive())
        balance_.col(i) = change;
      else if ((change - balance_.col(i)).norm() > wakes * still_[i])
        of.activate();
      const Vec3d force = change / (seconds * double{of.getInvMass()});
      of.applyCentralForce(to_bullet(force - given_.col(i)));
      given_.col(i) = force;
    }
  }

  /// y = A x, where A = 1 + damping of all springs; rows of held particles are left out.
  void multiply(const Columns& x, Columns& y) const {
    y = (1 + return_spring_.damping) * x;
    for (const Pair& pair : pairs_) {
      const Vec3d pulled = pair.spring.damping * (x.col(pair.a) - x.col(pair.b));
      y.col(pair.a) += pulled;
      y.col(pair.b) -= pulled;
    }
    clear_held(y);
  }

  void clear_held(Columns& columns) const {
    for (Index i = 0; i < count(); ++i)
      if (held_[i] != 0) columns.col(i).setZero();
  }

  /// solved_: velocities after the substep, relative to rest: A solved = relative - stiffness displaced, by conjugate gradients
  /// with the diagonal as preconditioner.
  void solve() {
    residual_ = relative_ - return_spring_.stiffness * displaced_;
    for (const Pair& pair : pairs_) {
      const Vec3d pulled = pair.spring.stiffness * (displaced_.col(pair.a) - displaced_.col(pair.b));
      residual_.col(pair.a) -= pulled;
      residual_.col(pair.b) += pulled;
    }
    for (Index i = 0; i < count(); ++i)
      solved_.col(i) = held_[i] != 0 ? Vec3d(relative_.col(i)) : Vec3d(residual_.col(i) / diagonal_[i]);
    if (pairs_.empty()) return;
    clear_held(residual_);
    const auto weighted = [&](const Columns& x) {
      return (x.colwise().squaredNorm().array() / diagonal_.transpose().array()).sum();
    };
    const double enough = kLeastResidual * weighted(residual_);
    multiply(solved_, product_);
    residual_ -= product_;
    double size = weighted(residual_);
    direction_ = residual_ * diagonal_.cwiseInverse().asDiagonal();
    for (int iteration = 0; iteration < kMostIterations && size > enough; ++iteration) {
      multiply(direction_, product_);
      const double along = direction_.cwiseProduct(product_).sum();
      if (!(along > 0)) return;
      solved_ += (size / along) * direction_;
      residual_ -= (size / along) * product_;
      const double left = weighted(residual_);
      direction_ = residual_ * diagonal_.cwiseInverse().asDiagonal() + (left / size) * direction_;
      size = left;
    }
  }

  void read() {
    const Mat3d model_from_world = world_from_model_.linear().inverse();
    for (Index i = 0; i < count(); ++i)
      displacements_[i].head<3>() = (model_from_world * (place_of(i) - rest_.col(i))).cast<float>();
  }

  btDynamicsWorld* world_;
  BulletBodyOptions options_;
  Affine3d world_from_model_;
  bool is_in_world_ = false;

  // ---- Of the set.
  std::uint64_t revision_ = 0;
  std::vector<std::uint64_t> serials_;
  std::vector<Grain> grains_;
  std::vector<double> still_;  ///< Metres a second at which a particle is still.
  std::vector<Pair> pairs_;
  std::vector<Index> all_;
  std::vector<ParticleRest> rests_;

  // ---- Rest places, metres of the world: as of the substep that Bullet reached, and where they are in remaining_ seconds.
  ModelPose pose_;  ///< Of target_.
  Columns rest_, target_, new_target_, old_target_, rest_velocity_;
  double remaining_ = 0;
  bool moves_ = false;
  double substep_ = kLikelySubstep;

  // ---- Springs.
  double springs_for_ = 0;  ///< The substep that they were computed for.
  Spring return_spring_;
  Eigen::VectorXd diagonal_;
  std::vector<char> held_;
  Columns displaced_, relative_, solved_, residual_, direction_, product_;
  Columns given_;    ///< Newtons that the bodies have of us.
  Columns balance_;  ///< The change of velocity that springs made when a body was last awake, metres a second.
  Vec3d gravity_ = Vec3d::Zero();

  std::vector<Vec4f> displacements_;
};

namespace {

Status check(const BulletBodyOptions& options) {
  const auto refuse = [](const char* what, double value, const char* wanted) {
    return Status::failure(StatusCode::invalid_argument, kNone, "%s is %g; it must be %s", what, value, wanted);
  };
  const auto is_at_least_zero = [](double value) { return value >= 0 && std::isfinite(value); };
  const auto is_positive = [](double value) { return value > 0 && std::isfinite(value); };
  if (!is_at_least_zero(options.return_stiffness))
    return refuse("return_stiffness", options.return_stiffness, "finite and not below 0");
  if (!(options.damping_ratio >= 0 && options.damping_ratio <= 10))
    return refuse("damping_ratio", options.damping_ratio, "in [0, 10]");
  if (!is_at_least_zero(options.neighbour_stiffness))
    return refuse("neighbour_stiffness", options.neighbour_stiffness, "finite and not below 0");
  if (!is_positive(options.mass)) return refuse("mass", options.mass, "finite and above 0");
  if (!is_positive(options.radius)) return refuse("radius", options.radius, "finite and above 0");
  if (!is_at_least_zero(options.friction)) return refuse("friction", options.friction, "finite and not below 0");
  if (!is_at_least_zero(options.weight)) return refuse("weight", options.weight, "finite and not below 0");
  if (options.collision_group == 0) return refuse("collision_group", 0, "another number than 0");
  return {};
}

Status check(const Affine3d& world_from_model) {
  if (!world_from_model.matrix().allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone, "world_from_model is not finite");
  if (!(world_from_model.linear().determinant() > 0))
    return Status::failure(StatusCode::invalid_argument, kNone, "world_from_model mirrors or flattens: its determinant is %g",
                           world_from_model.linear().determinant());
  return {};
}

}  // namespace
}  // namespace particles

bool has_bullet_body() { return true; }

BulletBody::BulletBody(std::unique_ptr<particles::BulletParticles> particles) : particles_(std::move(particles)) {}
BulletBody::~BulletBody() = default;
BulletBody::BulletBody(BulletBody&&) noexcept = default;
BulletBody& BulletBody::operator=(BulletBody&&) noexcept = default;

Result<BulletBody> BulletBody::create(const ParticleSet& set, btDynamicsWorld& world, const ModelPose& pose,
                                      const BulletBodyOptions& options, const Affine3d& world_from_model) {
  if (Status status = particles::check(options); !status) return status;
  if (Status status = particles::check(world_from_model); !status) return status;
  try {
    auto made = std::make_unique<particles::BulletParticles>(world, options, world_from_model);
    if (Status status = made->create(set, pose); !status) return status;
    return BulletBody(std::move(made));
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

Status BulletBody::before_step(const ParticleSet& set, const ModelPose& pose, double seconds) {
  return before_step(set, pose, seconds, particles_->world_from_model());
}

Status BulletBody::before_step(const ParticleSet& set, const ModelPose& pose, double seconds, const Affine3d& world_from_model) {
  if (!(seconds >= 0) || !std::isfinite(seconds))
    return Status::failure(StatusCode::invalid_argument, kNone, "seconds is %g; it must be finite and not below 0", seconds);
  if (Status status = particles::check(world_from_model); !status) return status;
  try {
    return particles_->before_step(set, pose, seconds, world_from_model);
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

void BulletBody::after_step() { particles_->after_step(); }
std::span<const Vec4f> BulletBody::displacements() const { return particles_->displacements(); }
std::uint32_t BulletBody::particle_count() const { return particles_->count(); }
btRigidBody& BulletBody::body(std::uint32_t particle) const { return particles_->body(particle); }

}  // namespace sunder
