#include <sunder/particles/particle_set.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>

#include "core/internal/ordered.h"
#include "particles/clusters/decompose.h"
#include "particles/clusters/gradients.h"
#include "particles/clusters/read_model.h"
#include "particles/clusters/tips.h"
#include "particles/repair/follow_history.h"
#include "particles/repair/repair.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {
using particles::Structure;

Status check_pose(const particles::CharacterLink& character, const ModelPose& pose) {
  if (pose.model_from_bone.size() != character.bone_count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu bones, the character has %zu",
                           pose.model_from_bone.size(), character.bone_count);
  if (pose.morph_weights.size() != character.morph_weight_count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu morph weights, the character has %zu",
                           pose.morph_weights.size(), character.morph_weight_count);
  for (std::uint32_t bone = 0; bone < pose.model_from_bone.size(); ++bone)
    if (!pose.model_from_bone[bone].matrix().allFinite())
      return Status::failure(StatusCode::non_finite_value, bone,
                             "the pose of bone %u is not finite", bone);
  for (std::uint32_t i = 0; i < pose.morph_weights.size(); ++i)
    if (!std::isfinite(pose.morph_weights[i]))
      return Status::failure(StatusCode::non_finite_value, i,
                             "morph weight %u of the pose is not finite", i);
  return {};
}

Status out_of_memory() {
  return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
}

/// @param report  its range in metres is written.
Status find_range(const DecompositionOptions& options, double diagonal,
                  DecompositionReport& report) {
  if (!(diagonal > 0))
    return Status::failure(StatusCode::empty_input, kNone,
                           "the model has no face that can be divided into particles");
  report.range = options.is_fraction ? options.range * diagonal : options.range;
  if (report.range >= double{std::numeric_limits<float>::min()} &&
      report.range <= double{std::numeric_limits<float>::max()})
    return {};
  return Status::failure(StatusCode::invalid_argument, kNone,
                         "the range of particles is %g m; it must be a finite float above 0",
                         report.range);
}

}  // namespace

ParticleSet::ParticleSet(std::unique_ptr<Structure> structure) : structure_(std::move(structure)) {}
ParticleSet::~ParticleSet() = default;
ParticleSet::ParticleSet(ParticleSet&&) noexcept = default;
ParticleSet& ParticleSet::operator=(ParticleSet&&) noexcept = default;

Result<ParticleSet> ParticleSet::create(const TornModel& model, const ModelPose& pose,
                                        const DecompositionOptions& options) {
  if (!(options.range > 0) || !std::isfinite(options.range))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the range of particles is %g; it must be finite and above 0",
                           options.range);
  try {
    const auto begin = std::chrono::steady_clock::now();
    auto structure = std::make_unique<Structure>();
    structure->character.bone_count = model.character().skeleton.bones.size();
    structure->character.morph_weight_count = model.character().rest_morph_weights.size();
    if (Status status = check_pose(structure->character, pose); !status) return status;
    particles::read_model(model, pose, *structure);
    if (Status status =
            find_range(options, particles::diagonal_of(*structure, model), structure->report);
        !status)
      return status;
    particles::decompose(model, options, *structure);
    structure->prepare_for_tears(model.surface().triangle_count());
    structure->report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return ParticleSet(std::move(structure));
  } catch (const std::length_error&) {
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "a range of %g makes more than %zu particles", options.range,
                           particles::kMaximumParticles);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

const DecompositionReport& ParticleSet::report() const { return structure_->report; }
std::uint32_t ParticleSet::particle_count() const {
  return static_cast<Index>(structure_->particles.size());
}
std::uint64_t ParticleSet::serial(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return structure_->particles[particle].serial;
}
std::uint32_t ParticleSet::seed(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return structure_->particles[particle].seed;
}
double ParticleSet::range(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return double{structure_->particles[particle].range};
}
std::uint32_t ParticleSet::member_count(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return structure_->particles[particle].member_count;
}

Result<std::vector<std::uint32_t>> ParticleSet::members(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  try {
    return structure_->members_of(particle);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

std::span<const ParticleNeighbour> ParticleSet::neighbours(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return structure_->particles[particle].neighbours;
}

double ParticleSet::coupling(std::uint32_t particle, const ParticleNeighbour& neighbour) const {
  SUNDER_ASSERT(particle < particle_count() && neighbour.particle < particle_count());
  const double least = std::min(structure_->particles[particle].weight,
                                structure_->particles[neighbour.particle].weight);
  return least > 0 ? std::min(1.0, neighbour.shared / least) : 0.0;
}

const ParticleInfluences& ParticleSet::parents(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return structure_->particles[particle].parents;
}
std::uint32_t ParticleSet::point_count() const { return structure_->points.count(); }
std::span<const ParticleMembership> ParticleSet::memberships(std::uint32_t point) const {
  SUNDER_ASSERT(point < point_count());
  return structure_->points.memberships_of(point);
}
std::span<const ParticleInfluences> ParticleSet::influences() const {
  return structure_->points.influences;
}
std::span<const ParticleGradients> ParticleSet::gradients(const TornModel& model) {
  try {
    return structure_->gradients->of(model.surface(), *structure_);
  } catch (const std::bad_alloc&) {
    return {};
  }
}
bool ParticleSet::is_broken() const { return structure_->tears.is_broken; }
bool ParticleSet::is_settled() const { return structure_->tears.band == nullptr; }
std::span<const std::uint32_t> ParticleSet::vertex_points(std::uint32_t mesh) const {
  SUNDER_ASSERT(mesh < structure_->vertex_points.of_mesh.size());
  return structure_->vertex_points.of_mesh[mesh];
}
std::span<const Vec3f> ParticleSet::positions() const { return structure_->points.positions; }
std::span<const LipEdge> ParticleSet::lips() const { return structure_->lips; }
std::uint64_t ParticleSet::revision() const { return structure_->revision; }

DirtyRanges ParticleSet::dirty_points() const {
  std::vector<Index>& dirty = structure_->dirty;  // their order has no meaning
  std::sort(dirty.begin(), dirty.end());
  return DirtyRanges::covering(dirty);
}

Result<std::vector<std::uint32_t>> ParticleSet::tips(const TornModel& model) const {
  try {
    return particles::find_tips(model, *structure_);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Status ParticleSet::rest(const ModelPose& pose, std::span<const std::uint32_t> particles,
                         std::span<ParticleRest> rest) const {
  particles::CharacterLink& character = structure_->character;
  if (Status status = check_pose(character, pose); !status) return status;
  if (rest.size() != particles.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "%zu particles are requested, but the output has %zu entries",
                           particles.size(), rest.size());
  if (Status status = character.pose.set(character.skins, pose); !status) return status;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    SUNDER_ASSERT(particles[i] < particle_count());
    rest[i] = character.pose.rest(structure_->particles[particles[i]]);
  }
  return {};
}

Status ParticleSet::follow(const TornModel& model, std::span<const ChangeRecord> changes) {
  Structure& structure = *structure_;
  if (&model.source() != structure.character.source)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the particles belong to another model, or it was compacted since; "
                           "create a new ParticleSet");
  if (structure.tears.is_broken)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "memory ran out in an earlier call; create a new ParticleSet");
  structure.dirty.clear();
  try {
    particles::follow_history(model, structure, changes);
    structure.note_dirty_points();
  } catch (const std::bad_alloc&) {
    structure.tears.is_broken = true;
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "out of memory; create a new ParticleSet");
  }
  return {};
}

bool ParticleSet::settle(const TornModel& model, std::uint32_t points) {
  Structure& structure = *structure_;
  particles::TearLog& tears = structure.tears;
  if (!tears.band || tears.is_broken || &model.source() != structure.character.source) return false;
  structure.dirty.clear();
  try {
    particles::settle_band(model, structure, std::max(1u, points));
    structure.note_dirty_points();
  } catch (const std::bad_alloc&) {
    tears.is_broken = true;
    return false;
  }
  structure.gradients->forget(model.surface(), structure.dirty);
  return tears.band != nullptr;
}

}  // namespace sunder
