#pragma once

#include <sunder/core/index.h>
#include <sunder/core/skeleton.h>
#include <sunder/particles/collider.h>
#include <sunder/particles/material.h>
#include <sunder/particles/particle_set.h>

#include <functional>
#include <memory>
#include <optional>
#include <span>

namespace sunder {

namespace particles {
struct BodyState;
}

/// What the displacement of a particle is fixed to while bones move.
enum class Follow : std::uint8_t {
  ride,  ///< The particle's own frame: it is turned and carried by the pose, and bones alone never excite it.
  lag,   ///< The room: the particle has inertia, and its rest place moves away from it.
};

struct SoftBodyOptions {
  Follow follow = Follow::ride;
  /// Whether a body that sleeps under `ride` looks at the pose in each step all the same, so that velocity() and place() of its
  /// particles are those of the pose. O(particles) a step then.
  bool tracks_rest = false;
};

/// An acceleration, m/s^2, at a place in model space and a time, seconds of all steps together. What is not finite counts as none.
using WindField = std::function<Vec3d(const Vec3d& place, double seconds)>;

/// Pull of the skin in itself, which parts the lips of a tear. It acts at lips alone: elsewhere it is in balance.
struct Tension {
  double newtons_per_metre = 0.0;  ///< >= 0.
  /// Where given: the unit direction, in the decomposition's pose, along which alone the tissue is under tension (as Langer's lines
  /// of skin are), at a place in that pose. What is not finite counts as none.
  std::function<Vec3d(const Vec3d& place)> direction;
};

struct HoldOptions {
  double stiffness = 1e6;  ///< 1/s^2, in (0, 1e12]: newtons a metre, for a kilogram of what is held.
};

using HoldId = std::uint64_t;

/// What colliders did in the last step.
struct ContactReport {
  std::uint32_t points = 0;  ///< Contact points that were pushed out.
  double deepest = 0.0;      ///< Metres by which a contact point is inside a collider still.
};

/// The motion of a ParticleSet: each particle hangs on a damped spring to where the pose puts it, and its neighbours pull at it.
///
/// A particle has a displacement u from its rest place and a velocity. The return spring is integrated in closed form; neighbours
/// and holds are solved for together, implicitly. So any step and any stiffness is stable. Particles that are quiet sleep: they
/// keep their displacement exactly and cost nothing.
///
/// Deterministic: the same calls give the same bits. See docs/particles.md.
class SUNDER_API SoftBody {
 public:
  /// A body at rest, asleep, of the first material throughout.
  /// @param particles  followed: what is torn shows in the next call. Outlives this, and stays where it is.
  /// @param pose       that of ParticleSet::create().
  /// @param materials  at least one.
  /// @return what the pose is refused for by ParticleSet::rest(); empty_input without material; the fault of a material, with its
  ///         index; limit_exceeded without enough memory. O(particles + pairs of neighbours).
  static Result<SoftBody> create(ParticleSet& particles, const ModelPose& pose, std::span<const SoftMaterial> materials,
                                 const SoftBodyOptions& options = {});
  ~SoftBody();
  SoftBody(SoftBody&&) noexcept;
  SoftBody& operator=(SoftBody&&) noexcept;

  // ---- What particles are made of. New particles are as the one that most of them was.

  /// @return index_out_of_range.
  Status set_material(std::uint32_t particle, std::uint32_t material);
  /// Changes a material wherever it is. @return index_out_of_range, or the fault of the material.
  Status change_material(std::uint32_t material, const SoftMaterial& to);
  [[nodiscard]] std::uint32_t material_of(std::uint32_t particle) const;
  [[nodiscard]] std::span<const SoftMaterial> materials() const;

  // ---- What acts on it. Every call answers index_out_of_range, non_finite_value, invalid_argument or limit_exceeded (out of
  // memory), and changes nothing then.

  /// Newton seconds, at once. To a point: shared out by its influences.
  Status add_impulse(std::uint32_t particle, const Vec3d& newton_seconds);
  Status add_point_impulse(std::uint32_t point, const Vec3d& newton_seconds);
  /// Newtons, until it is set anew.
  Status set_force(std::uint32_t particle, const Vec3d& newtons);
  /// m/s^2; zero to begin with.
  Status set_gravity(const Vec3d& acceleration);
  /// Asked for every particle in every step. None: no wind.
  Status set_wind(WindField wind);
  Status set_tension(Tension tension);

  /// Pulls a particle, or a point by its influences, to a place in model space. A moving target is followed a step behind. A hold
  /// of what vanishes is released. @return also invalid_argument for a point that nothing moves.
  Result<HoldId> hold(std::uint32_t particle, const Vec3d& target, const HoldOptions& options = {});
  Result<HoldId> hold_point(std::uint32_t point, const Vec3d& target, const HoldOptions& options = {});
  /// @return not_found for a hold that is none, or was released.
  Status move_hold(HoldId hold, const Vec3d& target);
  Status release(HoldId hold);

  /// Replaces all colliders; they come without velocity. @return the fault of a collider, with its index.
  Status set_colliders(std::span<const Collider> colliders);
  /// Where a collider is by the end of the next step. Its velocity is that of moving there from where it was after the last one.
  Status move_collider(std::uint32_t collider, const Vec3d& place, const Quatd& turn);
  [[nodiscard]] std::span<const Collider> colliders() const;

  // ---- Motion.

  /// Goes on in time.
  /// @param model    the one that was decomposed, as ParticleSet::follow() left it.
  /// @param pose     at the end of the step. Bones move evenly within the step.
  /// @param seconds  >= 0; more than an hour is an hour.
  /// @return non_finite_value or invalid_argument for `seconds` and the model, and what the pose is refused for. All is as it was
  ///         then, bit for bit. A body that sleeps under `ride`, with nothing set that could wake it, looks at neither.
  ///
  /// O(particles awake x their neighbours x iterations); with colliders, a wind or lag O(particles) too; asleep O(1). No allocation
  /// once warm.
  Status step(const TornModel& model, const ModelPose& pose, double seconds);

  /// One a particle: x y z of the displacement, metres of model space, and 0. What SkinnedMesh and shaders read.
  /// Of the particles as ParticleSet::follow() left them; valid until the next call that is not const.
  [[nodiscard]] std::span<const Vec4f> displacements();
  /// One a particle: how the pose turns what it holds, from the decomposition's pose to the last step's. Up to date for every
  /// particle that is displaced. A particle whose members are mirrored or flattened keeps the turn that it had.
  [[nodiscard]] std::span<const Mat3f> rotations();
  /// Vertices of a mesh that a displaced particle moves, ascending, apart. Valid until the next call that is not const.
  /// O(points of displaced particles) where other particles are displaced than at the last call, else O(1).
  [[nodiscard]] std::span<const IndexRange> moved_vertices(const TornModel& model, std::uint32_t mesh);

  /// Metres and metres a second, model space, after the last step; unchecked. Velocities are those of the particle in the room:
  /// its rest's own is in them. What has slept through the last steps without a look at the pose is where it was, at velocity 0.
  [[nodiscard]] Vec3d place(std::uint32_t particle) const;
  [[nodiscard]] Vec3d displacement(std::uint32_t particle) const;
  [[nodiscard]] Vec3d velocity(std::uint32_t particle) const;
  /// Mean of the particles that move a point, by its influences.
  [[nodiscard]] Vec3d point_displacement(std::uint32_t point) const;
  [[nodiscard]] Vec3d point_velocity(std::uint32_t point) const;

  [[nodiscard]] std::uint32_t particle_count() const;
  [[nodiscard]] bool is_awake(std::uint32_t particle) const;
  [[nodiscard]] std::uint32_t awake_count() const;
  [[nodiscard]] const ContactReport& contacts() const;

 private:
  explicit SoftBody(std::unique_ptr<particles::BodyState> state);
  std::unique_ptr<particles::BodyState> state_;
};

}  // namespace sunder
