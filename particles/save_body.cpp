#include <sunder/particles/soft_body.h>

#include <new>

#include "core/internal/out_of_memory.h"
#include "particles/body_state.h"
#include "particles/clusters/tape.h"
#include "particles/internal/recorded_limits.h"
#include "particles/motion/plasticity.h"

namespace sunder {
namespace {

using particles::BodyState;
using particles::kMostRecordedForce;
using particles::kMostRecordedLength;
using particles::kMostRecordedSeconds;
using particles::Motion;
using particles::Tape;

constexpr double kMostKeptStrain = 1e3;  // the largest limit of a material
constexpr std::uint32_t kBodyVersion = 9;

void describe(Tape& tape, SoftMaterial& of) {
  for (double* value :
       {&of.return_frequency, &of.damping_ratio, &of.membrane_stiffness, &of.membrane_damping,
        &of.areal_density, &of.range, &of.stretch_limit, &of.strength, &of.toughness,
        &of.flaw_length, &of.yield_stretch, &of.plastic_limit})
    tape(*value);
  if (!tape.is_reading()) return;
  if (const Status status = validate_material(of); !status)
    tape.fail(status.code(), "a material is invalid");
}

void describe(Tape& tape, Collider& of) {
  auto kind = static_cast<std::uint32_t>(of.shape.index());
  tape.small(kind, 4);
  if (tape.is_reading()) {
    if (kind == 0) of.shape = Collider::Sphere();
    if (kind == 1) of.shape = Collider::Capsule();
    if (kind == 2) of.shape = Collider::Box();
    if (kind == 3) of.shape = Collider::HalfSpace();
  }
  const auto length = [&](double& value) { tape.within(value, 0, kMostRecordedLength); };
  if (auto* sphere = std::get_if<Collider::Sphere>(&of.shape)) length(sphere->radius);
  if (auto* capsule = std::get_if<Collider::Capsule>(&of.shape)) {
    length(capsule->radius);
    length(capsule->half_length);
  }
  if (auto* box = std::get_if<Collider::Box>(&of.shape))
    tape.within(box->half_size, kMostRecordedLength);
  tape.within(of.place, kMostRecordedLength);
  for (int i = 0; i < 4; ++i) tape(of.turn.coeffs()[i]);
  tape.within(of.friction, 0, kMostRecordedForce);
  if (!tape.is_reading()) return;
  if (const Status status = validate_collider(of); !status)
    tape.fail(status.code(), "a collider is invalid");
}

void describe(Tape& tape, std::vector<Collider>& of) {
  const std::size_t count = tape.size(of.size());
  if (tape.is_reading()) of.clear();
  for (std::size_t i = 0; i < count && tape.status(); ++i) {
    if (tape.is_reading()) of.push_back(Collider{Collider::HalfSpace()});
    describe(tape, of[i]);
  }
}

/// The parts of a body that a recorded state contains, and that are restored together.
struct Recorded {
  std::uint64_t revision = 0;
  std::vector<SoftMaterial> materials;
  Motion motion;
  bool is_graph_stale = false;
  particles::RestMotion rests;
  Vec3d gravity = Vec3d::Zero();
  double tension = 0, time = 0, step_seconds = 0, still_seconds = 0;
  bool adds_pose_strain = false, is_tension_stale = false, is_disturbed = false;
  particles::HoldList holds;
  particles::ThreadList threads;
  struct OfContact {
    std::vector<Collider> colliders, before;
    bool is_changed = false;
    ContactReport report;
  } contact;
};

Recorded recorded(const BodyState& state) {
  const auto colliders = state.contact.colliders(), before = state.contact.before();
  return {state.revision,
          state.materials,
          state.motion,
          state.graph.is_stale,
          state.rests,
          state.outer.gravity,
          state.outer.tension.newtons_per_metre,
          state.outer.time,
          state.outer.step_seconds,
          state.sleep.still_seconds(),
          state.outer.tension.adds_pose_strain,
          state.outer.is_tension_stale,
          state.outer.is_disturbed,
          state.holds,
          state.outer.threads,
          {{colliders.begin(), colliders.end()},
           {before.begin(), before.end()},
           state.contact.is_changed(),
           state.contact.report()}};
}

void describe(Tape& tape, Motion& of) {
  tape.all(of.serials);
  tape.all(of.material_of);
  const auto pass = [&](std::vector<Vec3d>& column, double most) {
    tape.each(column, [&](Vec3d& value) { tape.within(value, most); });
  };
  for (auto* column : {&of.displacements, &of.velocities, &of.starts, &of.quiet.from})
    pass(*column, kMostRecordedLength);
  for (auto* column : {&of.forces, &of.lip_forces, &of.winds, &of.quiet.pulls})
    pass(*column, kMostRecordedForce);
  for (auto* flags : {&of.awake, &of.touched, &of.bound, &of.tired})
    tape.each(*flags, [&](std::uint8_t& flag) { tape.small(flag, 2); });
  tape.each(of.quiet.seconds,
            [&](double& seconds) { tape.within(seconds, 0, kMostRecordedSeconds); });
  tape.each(of.plastic.strains, [&](Mat3d& strain) { tape.within(strain, kMostKeptStrain); });
  of.plastic.forces.assign(of.plastic.strains.size(), Vec3d::Zero());
  of.awake_count = 0;
  for (const std::uint8_t awake : of.awake) of.awake_count += awake;
}

void describe(Tape& tape, Recorded& of, const ParticleSet& set) {
  tape(of.revision);
  tape.require(tape.size(of.materials.size()) == of.materials.size(),
               "the body has another number of materials");
  for (SoftMaterial& material : of.materials) describe(tape, material);
  describe(tape, of.motion);
  tape(of.is_graph_stale);
  of.rests.describe(tape);
  tape.within(of.gravity, kMostRecordedForce);
  tape.within(of.tension, 0, kMostRecordedForce);
  for (double* seconds : {&of.time, &of.step_seconds, &of.still_seconds})
    tape.within(*seconds, 0, kMostRecordedSeconds);
  tape(of.adds_pose_strain);
  tape(of.is_tension_stale);
  tape(of.is_disturbed);
  of.holds.describe(tape, of.motion.count(), set.point_count());
  of.threads.describe(tape);
  describe(tape, of.contact.colliders);
  describe(tape, of.contact.before);
  tape(of.contact.is_changed);
  tape(of.contact.report.points);
  tape.within(of.contact.report.deepest, 0, kMostRecordedLength);
}

/// Whether all arrays have an entry per particle.
bool has_count(const Recorded& of, std::size_t count) {
  const Motion& motion = of.motion;
  bool has = motion.serials.size() == count && motion.material_of.size() == count &&
             motion.quiet.seconds.size() == count && of.rests.count() == count;
  for (const auto* column :
       {&motion.displacements, &motion.velocities, &motion.starts, &motion.forces,
        &motion.lip_forces, &motion.winds, &motion.quiet.from, &motion.quiet.pulls})
    has &= column->size() == count;
  for (const auto* flags : {&motion.awake, &motion.touched, &motion.bound, &motion.tired})
    has &= flags->size() == count;
  return has && (motion.plastic.strains.empty() || motion.plastic.strains.size() == count);
}

/// Whether particles, holds and threads are those of the set.
bool is_of_set(Recorded& of, const ParticleSet& set) {
  if (of.motion.count() != set.particle_count()) return false;
  for (Index p = 0; p < of.motion.count(); ++p)
    if (of.motion.serials[p] != set.serial(p)) return false;
  return of.threads.find_held(set) && of.holds.find_held(set);
}

Status check(Recorded& of, const BodyState& state) {
  const std::size_t count = of.motion.displacements.size();
  if (!has_count(of, count))
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "a recorded state of a soft body has arrays of different sizes");
  // An older state follows the set in the next call.
  if (of.revision > state.set->revision() ||
      (of.revision == state.set->revision() && !is_of_set(of, *state.set)))
    return Status::failure(
        StatusCode::size_mismatch, kNone,
        "a recorded state of a soft body has %zu particles, or holds or threads, "
        "that are not those of the set, which has %u particles",
        count, state.set->particle_count());
  if (of.contact.colliders.size() != of.contact.before.size())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "a recorded state of a soft body has other colliders than before");
  for (const Index material : of.motion.material_of)
    if (material >= of.materials.size())
      return Status::failure(StatusCode::index_out_of_range, material,
                             "a recorded state of a soft body names material %u", material);
  return {};
}

/// The motion that renderers read.
particles::ShownMotion shown_of(const Recorded& of) {
  particles::ShownMotion shown;
  for (Index p = 0; p < of.motion.count(); ++p) {
    const Vec3d& u = of.motion.displacements[p];
    shown.displacements.emplace_back() << u.cast<float>(), 0.0f;
    shown.turns.emplace_back(of.rests.turn(p).cast<float>());
    shown.is_displaced.push_back(u != Vec3d::Zero() ? 1 : 0);
    shown.displaced_count += shown.is_displaced.back();
  }
  return shown;
}

void set_state(Recorded&& of, BodyState& state) {
  state.contact.follow(static_cast<Index>(of.motion.displacements.size()));
  state.contact.restore(of.contact.colliders, of.contact.before, of.contact.is_changed,
                        of.contact.report);
  const std::uint64_t key = state.shown.displaced_key + 1;
  state.shown = shown_of(of);
  state.shown.displaced_key = key;
  state.revision = of.revision;
  state.materials = std::move(of.materials);
  state.motion = std::move(of.motion);
  state.rests = std::move(of.rests);
  state.poses = {};
  state.outer.gravity = of.gravity;
  state.outer.tension.newtons_per_metre = of.tension;
  state.outer.tension.adds_pose_strain = of.adds_pose_strain;
  state.outer.time = of.time;
  state.outer.step_seconds = of.step_seconds;
  state.outer.has_blown = true;
  state.outer.is_tension_stale = of.is_tension_stale;
  state.outer.is_disturbed = of.is_disturbed;
  state.sleep.set_still_seconds(of.still_seconds);
  state.holds = std::move(of.holds);
  state.outer.threads = std::move(of.threads);
  state.graph.is_stale = true;
}

}  // namespace

Result<StateArrays> SoftBody::save() const {
  try {
    StateArrays arrays;
    arrays.version = kBodyVersion;
    Tape tape = Tape::writer(arrays);
    Recorded of = recorded(*state_);
    describe(tape, of, *state_->set);
    return arrays;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Status SoftBody::restore(const StateArrays& arrays) {
  if (arrays.version != kBodyVersion)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "a recorded state of a soft body has version %u; this library reads %u",
                           arrays.version, kBodyVersion);
  try {
    state_->follow_particles();
    Tape tape = Tape::reader(arrays);
    Recorded of = recorded(*state_);
    describe(tape, of, *state_->set);
    tape.end();
    if (!tape.status()) return tape.status();
    if (Status status = check(of, *state_); !status) return status;
    const bool is_graph_stale = of.is_graph_stale || of.revision != state_->set->revision();
    state_->reserve_for(static_cast<Index>(of.motion.displacements.size()));
    set_state(std::move(of), *state_);
    // The springs follow from the set and the materials.
    if (!is_graph_stale) {
      particles::connect(*state_->set, state_->materials, state_->motion.material_of,
                         state_->graph);
      particles::push_by_strains(*state_->set, state_->graph, state_->motion);
    }
    return {};
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

}  // namespace sunder
