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
#include <vector>

namespace sunder {

namespace particles {
struct BodyState;
struct BodyStateOf;
}  // namespace particles

/// The frame in which the displacement of a particle is constant while bones move.
enum class Follow : std::uint8_t {
  /// The particle's own frame: displacements move and rotate with the pose, and bones alone never
  /// cause any.
  ride,
  lag,  ///< Model space: the particle has inertia, and its rest moves away from it.
};

/// Lips and flaps do not pass through one another, nor through the skin below. Costs nothing while
/// there are no lips, or all sleeps.
struct SelfContact {
  double thickness = 0.0;  ///< Of the tissue, metres, to 1e9; 0: nothing touches.
  double friction = 0.0;   ///< Greatest ratio of tangential to normal force, [0, 1e12].
};

struct SoftBodyOptions {
  Follow follow = Follow::ride;
  /// Whether a body that sleeps under `ride` evaluates the pose in each step, so that velocity()
  /// and place() of its particles are those of the pose. Costs O(particles) per step.
  bool tracks_rest = false;
  SelfContact self_contact = {};
};

/// An acceleration, m/s^2, at a position in model space and a time, in seconds of all steps. Values
/// that are not finite count as zero. Must not throw.
using WindField = std::function<Vec3d(const Vec3d& place, double seconds)>;

/// Tension in the skin, which pulls the lips of a tear apart. It acts at lips only; elsewhere it is
/// balanced.
struct Tension {
  double newtons_per_metre = 0.0;  ///< >= 0.
  /// Optional: the unit direction, at a position in the decomposition's pose, of a tension in one
  /// direction only, such as along Langer's lines of skin. Values that are not finite count as
  /// none. Must not throw.
  std::function<Vec3d(const Vec3d& place)> direction;
  /// Whether the pose adds to it: tissue that bones stretch relative to the decomposition's pose
  /// pulls more at its lips, by membrane_stiffness times the strain, and tissue that they compress
  /// less. Lips are never pushed together. Costs O(lip edges) in each step of another pose.
  bool adds_pose_strain = false;
  /// Optional: the share of it at points of the surface, 0 to 1, such as those of one wound. A lip
  /// edge is pulled by the smaller share of its ends; points beyond the last entry have 1.
  std::vector<float> shares = {};
};

struct HoldOptions {
  /// 1/s^2, in (0, 1e12]: newtons per metre, for each kilogram that is held.
  double stiffness = 1e6;
};

using HoldId = std::uint64_t;

/// The effect of colliders in the last step.
struct ContactReport {
  std::uint32_t points = 0;  ///< Number of contact points that were pushed out.
  double deepest = 0.0;      ///< Largest depth of a contact point inside a collider, metres.
};

/// The load of a thread of a suture.
struct ThreadLoad {
  double newtons = 0.0;    ///< With which it pulled its lips together in the last step.
  bool is_broken = false;  ///< It pulls no more. Undo and redo of the suture tie it anew.
};

/// The motion of a point of the surface.
struct PointMotion {
  bool is_known = false;
  std::uint32_t material = 0;  ///< Of the particle that moves it most.
  Vec3d displacement = Vec3d::Zero(), velocity = Vec3d::Zero();
};

/// The motion at a point that particles move; unknown where none does.
/// @param particles  SoftBody::particle_motions(). Unchecked: `of` names some of these.
[[nodiscard]] SUNDER_API PointMotion motion_at(const ParticleInfluences& of,
                                               std::span<const PointMotion> particles);

/// The motion of a ParticleSet: each particle has a displacement and a velocity relative to its
/// rest. A damped spring pulls it to its rest, and its neighbours pull at it: the finite volumes of
/// the membrane that SoftMaterial describes. The return spring is
/// integrated in closed form, neighbours and holds implicitly, so any step and any stiffness is
/// stable. Quiet particles sleep: they keep their displacement and cost nothing.
///
/// Deterministic: the same calls give the same bits. Method: docs/particles.md. Not thread-safe:
/// one thread at a time per body and its set; different bodies on different sets are independent.
class SUNDER_API SoftBody {
 public:
  /// A body at rest, asleep, with the first material for all particles. O(particles + pairs of
  /// neighbours).
  ///
  /// @param particles  the set that it follows; must outlive the body and must not be moved.
  /// @param pose       that of ParticleSet::create().
  /// @param materials  at least one.
  /// @return as ParticleSet::rest() for the pose; empty_input without material; the fault of a
  ///         material, with its index; non_finite_value or invalid_argument for the self-contact;
  ///         limit_exceeded if out of memory.
  static Result<SoftBody> create(ParticleSet& particles, const ModelPose& pose,
                                 std::span<const SoftMaterial> materials,
                                 const SoftBodyOptions& options = {});
  ~SoftBody();
  SoftBody(SoftBody&&) noexcept;
  SoftBody& operator=(SoftBody&&) noexcept;

  // ---- Materials. A new particle has the material of its parent with the largest weight.
  // Functions below that return a Status or Result may return index_out_of_range, non_finite_value,
  // invalid_argument or limit_exceeded (out of memory), and change nothing then.

  Status set_material(std::uint32_t particle, std::uint32_t material);
  /// Changes a material wherever it is used. @return also the fault of the material.
  Status change_material(std::uint32_t material, const SoftMaterial& to);
  [[nodiscard]] std::uint32_t material_of(std::uint32_t particle) const;
  [[nodiscard]] std::span<const SoftMaterial> materials() const;
  /// Kilograms: the areal density of its material times ParticleSet::area(), or times a hundredth
  /// of its squared range if its cell is smaller.
  [[nodiscard]] double mass(std::uint32_t particle) const;

  // ---- Forces.

  /// Newton seconds, applied at once. On a point: distributed by its influences.
  /// @return also invalid_argument for a velocity beyond 1e9 m/s. Forces, gravity and tension are
  ///         at most 1e12, targets of holds at most 1e9 m, as in recorded states.
  Status add_impulse(std::uint32_t particle, const Vec3d& newton_seconds);
  Status add_point_impulse(std::uint32_t point, const Vec3d& newton_seconds);
  /// Newtons, constant until it is set again.
  Status set_force(std::uint32_t particle, const Vec3d& newtons);
  /// m/s^2; initially zero.
  Status set_gravity(const Vec3d& acceleration);
  /// Called for every particle in every step. Empty: no wind.
  Status set_wind(WindField wind);
  Status set_tension(Tension tension);

  /// Pulls a particle, or a point by its influences, to a place in model space. A moving target is
  /// followed with a delay of one step. A hold on a particle or point that vanishes is released.
  /// @return also invalid_argument for a point that belongs to no particle.
  Result<HoldId> hold(std::uint32_t particle, const Vec3d& target, const HoldOptions& options = {});
  Result<HoldId> hold_point(std::uint32_t point, const Vec3d& target,
                            const HoldOptions& options = {});
  ///
  /// @return not_found for a hold that does not exist, or was released.
  Status move_hold(HoldId hold, const Vec3d& target);
  Status release(HoldId hold);

  /// Replaces all colliders; they start without velocity. @return the fault of a collider, with its
  /// index.
  Status set_colliders(std::span<const Collider> colliders);
  /// Sets the position of a collider at the end of the next step. Its velocity follows from its
  /// position after the previous step.
  Status move_collider(std::uint32_t collider, const Vec3d& place, const Quatd& turn);

  /// Gives each particle the displacement and velocity at its points, and the material there if
  /// this body has one of that index: for a piece that a tear separated and that becomes a body of
  /// its own. Nothing else acts on it yet.
  /// @param motions  per point of this body's set; unknown ones are left out: motion_at() with the
  ///                 particle_motions() of the other body, kept if that changes first.
  /// @return size_mismatch, non_finite_value, limit_exceeded. O(points), allocates.
  Status inherit_motion_from(std::span<const PointMotion> motions);
  /// The motion of each particle; empty before displacements() or step() has followed the set.
  /// O(particles). @throws std::bad_alloc
  [[nodiscard]] std::vector<PointMotion> particle_motions() const;

  // ---- Motion.

  /// Advances by a time step. O(awake particles x neighbours x iterations); with colliders, wind or
  /// lag also O(particles); asleep O(1). No allocation once warm.
  ///
  /// @param model    the model of the set, as ParticleSet::follow() left it.
  /// @param pose     at the end of the step. Bones move at constant speed within the step.
  /// @param seconds  >= 0; more than an hour counts as an hour.
  /// @param settled_points  for ParticleSet::settle(); 0: the caller settles the set.
  /// @return non_finite_value or invalid_argument for `seconds` and the model, and as
  ///         ParticleSet::rest() for the pose: nothing is changed. A body that sleeps under `ride`,
  ///         without settings that could wake it, checks neither. limit_exceeded if out of memory:
  ///         the step may be incomplete.
  Status step(const TornModel& model, const ModelPose& pose, double seconds,
              std::uint32_t settled_points = 500);

  /// Displacement of each particle, as ParticleSet::follow() left them: x, y, z in metres, model
  /// space, and 0; for SkinnedMesh and shaders. Valid until the next call that is not const. Empty
  /// if out of memory, like the next two.
  [[nodiscard]] std::span<const Vec4f> displacements();
  /// Per particle: its rotation from the decomposition's pose to that of the last step. Up to date
  /// for every displaced particle. A particle whose members are mirrored or flattened keeps its
  /// last rotation.
  [[nodiscard]] std::span<const Mat3f> rotations();
  /// Vertices of a mesh that displaced particles move, as ascending, separate ranges. Valid until
  /// the next call that is not const. O(1) if nothing changed since the last call; otherwise
  /// O(members of particles that became displaced or stopped, points that operations changed, and
  /// vertices / 64), at most O(vertices).
  [[nodiscard]] std::span<const IndexRange> moved_vertices(const TornModel& model,
                                                           std::uint32_t mesh);

  /// After the last step, model space, metres and metres per second; indices are unchecked. The
  /// velocity includes that of the rest. Particles that slept through the last steps have the
  /// position in the last evaluated pose, and velocity 0.
  [[nodiscard]] Vec3d place(std::uint32_t particle) const;
  [[nodiscard]] Vec3d displacement(std::uint32_t particle) const;
  [[nodiscard]] Vec3d velocity(std::uint32_t particle) const;
  /// Mean over the particles of a point, by its influences.
  [[nodiscard]] Vec3d point_displacement(std::uint32_t point) const;

  [[nodiscard]] std::uint32_t particle_count() const;
  [[nodiscard]] bool is_awake(std::uint32_t particle) const;
  [[nodiscard]] std::uint32_t awake_count() const;
  /// Whether step() may move anything in an unchanged pose: particles are awake, or forces, tears
  /// or settings changed since the last step. O(1).
  [[nodiscard]] bool needs_step() const;
  [[nodiscard]] const ContactReport& contacts() const;

  /// Bytes of the body, without those of its set.
  [[nodiscard]] std::size_t memory_bytes() const;
  /// The whole state, except the set, names of materials, the wind, and the direction and
  /// the shares of the tension. O(particles), allocates. @return limit_exceeded: out of memory.
  [[nodiscard]] Result<StateArrays> save() const;
  /// Sets the state: the body goes on with the same bits as the saved one.
  /// @param state  of a body with the same number of materials, whose set had the state that this
  ///         body's set has.
  /// @return invalid_argument, index_out_of_range, size_mismatch or non_finite_value if the arrays
  ///         are no such state (nothing is changed); limit_exceeded.
  Status restore(const StateArrays& state);

 private:
  friend struct particles::BodyStateOf;
  explicit SoftBody(std::unique_ptr<particles::BodyState> state);
  std::unique_ptr<particles::BodyState> state_;
};

/// The loads of all threads of sutures, in the order of threads_of(), after the last step or
/// displacements(). Valid until the next call on the body that is not const.
[[nodiscard]] SUNDER_API std::span<const ThreadLoad> thread_loads(const SoftBody& body);

}  // namespace sunder
