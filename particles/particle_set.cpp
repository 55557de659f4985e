#include <sunder/particles/particle_set.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "core/internal/threads.h"
#include "particles/clusters/check_pose.h"
#include "particles/clusters/decompose_model.h"
#include "particles/clusters/gradients.h"
#include "particles/clusters/member_search.h"
#include "particles/clusters/set_data.h"
#include "particles/clusters/tips.h"
#include "particles/repair/follow_history.h"
#include "particles/repair/repair.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {
using particles::Structure;

/// Whether no call has changed a model that its particles do not have followed yet.
bool is_untouched(const TornModel& model, std::span<const ChangeRecord> changes) {
  if (!model.is_in_stroke()) return model.newest_operation() == 0;
  return std::ranges::all_of(changes, [](const ChangeRecord& change) {
    return change.meshes.empty() && change.point_count == 0;
  });
}

}  // namespace

ParticleSet::ParticleSet(std::unique_ptr<particles::SetData> data) : data_(std::move(data)) {}
ParticleSet::~ParticleSet() = default;
ParticleSet::ParticleSet(ParticleSet&&) noexcept = default;
ParticleSet& ParticleSet::operator=(ParticleSet&&) noexcept = default;

Result<ParticleSet> ParticleSet::create(const TornModel& model, const ModelPose& pose,
                                        const DecompositionOptions& options,
                                        const AuthoredTissue& tissue) {
  Result<std::unique_ptr<Structure>> made =
      particles::decompose_model(model, pose, options, tissue);
  if (!made) return made.error();
  try {
    auto data = std::make_unique<particles::SetData>();
    data->own = std::move(*made);
    data->own->prepare_for_tears(model.surface().triangle_count());
    return ParticleSet(std::move(data));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Result<ParticleSet> ParticleSet::create(std::shared_ptr<const ParticleAsset> asset,
                                        const TornModel& model) {
  if (!asset)
    return Status::failure(StatusCode::empty_input, kNone, "there is no asset of particles");
  const Structure& shared = *asset->structure_;
  if (&model.source() != shared.character.source || model.newest_operation() != 0 ||
      model.point_count() != shared.points.count())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the asset of particles is of another model, or the model is torn");
  try {
    auto data = std::make_unique<particles::SetData>();
    data->shared = asset->structure_;
    return ParticleSet(std::move(data));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

const DecompositionReport& ParticleSet::report() const { return data_->without_points().report; }
std::uint32_t ParticleSet::particle_count() const {
  return static_cast<Index>(data_->without_points().particles.size());
}
std::uint64_t ParticleSet::serial(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return data_->without_points().particles[particle].serial;
}
std::uint32_t ParticleSet::seed(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return data_->without_points().particles[particle].seed;
}
double ParticleSet::range(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return double{data_->without_points().particles[particle].range};
}
std::uint32_t ParticleSet::member_count(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return data_->without_points().particles[particle].member_count;
}

Result<std::vector<std::uint32_t>> ParticleSet::members(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  try {
    particles::MemberSearch search(data_->now());
    const std::span<const Index> members = search.members_of(particle);
    return std::vector<std::uint32_t>(members.begin(), members.end());
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

std::span<const ParticleNeighbour> ParticleSet::neighbours(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return data_->without_points().particles[particle].neighbours;
}

double ParticleSet::area(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return data_->without_points().particles[particle].area;
}

const ParticleInfluences& ParticleSet::parents(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return data_->without_points().particles[particle].parents;
}
std::uint32_t ParticleSet::point_count() const { return data_->point_count(); }
std::span<const ParticleMembership> ParticleSet::memberships(std::uint32_t point) const {
  SUNDER_ASSERT(point < point_count());
  const Structure* const structure = data_->find();
  if (structure == nullptr) return {};
  return structure->points.memberships_of(point);
}
std::span<const ParticleInfluences> ParticleSet::influences() const {
  const Structure* const structure = data_->find();
  if (structure == nullptr) return {};
  return structure->points.influences;
}
std::span<const std::uint32_t> ParticleSet::owners() const {
  const Structure* const structure = data_->find();
  if (structure == nullptr) return {};
  return structure->points.owners;
}
std::span<const ParticleGradients> ParticleSet::gradients(const TornModel& model) {
  if (!data_->own && data_->shared->gradients->is_wanted())
    return data_->shared->gradients->known();
  try {
    Structure& structure = data_->to_change();
    if (structure.gradients->is_up_to_date(structure.points.count()))
      return structure.gradients->known();
    // A fork may be copying it.
    const std::shared_ptr<particles::ForkLink> link = data_->fork.lock();
    std::unique_lock<Mutex> lock;
    if (link) lock = std::unique_lock(link->mutex);
    return structure.gradients->of(model.surface(), structure);
  } catch (const std::bad_alloc&) {
    return {};
  }
}
bool ParticleSet::is_broken() const {
  return data_->is_broken || data_->without_points().tears.is_broken;
}
std::size_t ParticleSet::memory_bytes() const { return data_->memory_bytes(); }
bool ParticleSet::is_settled() const { return data_->without_points().tears.band == nullptr; }
std::span<const std::uint32_t> ParticleSet::vertex_points(std::uint32_t mesh) const {
  const Structure* const structure = data_->find();
  if (structure == nullptr) return {};
  SUNDER_ASSERT(mesh < structure->vertex_points.of_mesh.size());
  return structure->vertex_points.of_mesh[mesh];
}
std::span<const Vec3f> ParticleSet::positions() const {
  const Structure* const structure = data_->find();
  if (structure == nullptr) return {};
  return structure->points.positions;
}
std::span<const LipEdge> ParticleSet::lips() const { return data_->without_points().lips; }
std::uint64_t ParticleSet::revision() const { return data_->without_points().revision; }

DirtyRanges ParticleSet::dirty_points() const {
  if (!data_->own) return {};
  std::vector<Index>& dirty = data_->own->dirty;  // their order has no meaning
  std::sort(dirty.begin(), dirty.end());
  return DirtyRanges::covering(dirty);
}

Result<std::vector<std::uint32_t>> find_tips(const ParticleSet& particles, const TornModel& model) {
  try {
    return particles::find_tips(model, particles::StructureOf::in(particles));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Status ParticleSet::rest(const ModelPose& pose, std::span<const std::uint32_t> particles,
                         std::span<ParticleRest> rest) const {
  const particles::CharacterLink& character = data_->without_points().character;
  if (Status status = particles::check_pose(character, pose); !status) return status;
  if (rest.size() != particles.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "%zu particles are requested, but the output has %zu entries",
                           particles.size(), rest.size());
  particles::SurfacePose& posed = data_->pose;
  try {
    if (!data_->has_pose) posed.begin(character.skins, character.morph_weight_count);
    data_->has_pose = true;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
  if (Status status = posed.set(character.skins, pose); !status) return status;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    SUNDER_ASSERT(particles[i] < particle_count());
    rest[i] = posed.rest(data_->without_points().particles[particles[i]]);
  }
  return {};
}

Status ParticleSet::follow(const TornModel& model, std::span<const ChangeRecord> changes) {
  if (&model.source() != data_->without_points().character.source)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the particles belong to another model, or it was compacted since; "
                           "create a new ParticleSet");
  if (is_broken())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "memory ran out in an earlier call; create a new ParticleSet");
  if (!data_->own && is_untouched(model, changes)) return {};
  data_->end_fork();
  try {
    Structure& structure = data_->to_change();
    structure.dirty.clear();
    particles::follow_history(model, structure, changes);
    if (structure.follow_threads(model)) ++structure.revision;
    structure.note_dirty_points();
  } catch (const std::bad_alloc&) {
    data_->is_broken = true;
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "out of memory; create a new ParticleSet");
  }
  return {};
}

Status ParticleSet::prepare_to_follow() {
  if (data_->own && !data_->is_packed()) return {};
  try {
    data_->end_fork();
    (void)data_->to_change();
    return {};
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Status ParticleSet::pack() {
  try {
    data_->pack();
    return {};
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

bool ParticleSet::settle(const TornModel& model, std::uint32_t points) {
  if (!data_->own) return false;
  Structure& structure = *data_->own;
  particles::TearLog& tears = structure.tears;
  if (!tears.band || is_broken() || &model.source() != structure.character.source) return false;
  if (!data_->fork.expired()) return true;
  structure.dirty.clear();
  try {
    particles::settle_band(model, structure, std::max(1u, points));
    structure.note_dirty_points();
  } catch (const std::bad_alloc&) {
    data_->is_broken = true;
    return false;
  }
  structure.gradients->forget(model.surface(), structure.dirty, &tears.done.back());
  return tears.band != nullptr;
}

}  // namespace sunder
