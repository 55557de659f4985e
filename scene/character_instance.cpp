#include <sunder/scene/character_instance.h>

#include <cmath>
#include <new>
#include <utility>

#include "scene/actor/piece_tissue.h"
#include "scene/instance_state.h"
#include "scene/snapshot/check_pose.h"

namespace sunder {
namespace {

Status no_stroke() {
  return Status::failure(StatusCode::invalid_argument, kNone, "no stroke is in progress");
}

Status check_seconds(double seconds) {
  if (!std::isfinite(seconds))
    return Status::failure(StatusCode::non_finite_value, kNone,
                           "the time since the last frame is not finite");
  if (seconds < 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the time since the last frame is %g s; it must not be negative",
                           seconds);
  return {};
}

bool is_same_pose(const ModelPose& a, const ModelPose& b) {
  if (a.model_from_bone.size() != b.model_from_bone.size() || a.morph_weights != b.morph_weights)
    return false;
  for (std::size_t i = 0; i < a.model_from_bone.size(); ++i)
    if (a.model_from_bone[i].matrix() != b.model_from_bone[i].matrix()) return false;
  return true;
}

}  // namespace

CharacterInstance::CharacterInstance(std::unique_ptr<State> state) : state_(std::move(state)) {}
CharacterInstance::~CharacterInstance() = default;
CharacterInstance::CharacterInstance(CharacterInstance&&) noexcept = default;
CharacterInstance& CharacterInstance::operator=(CharacterInstance&&) noexcept = default;

Result<CharacterInstance> CharacterInstance::create(std::shared_ptr<const CharacterAsset> asset,
                                                    const TornCapacity& capacity) {
  if (!asset) return Status::failure(StatusCode::empty_input, kNone, "there is no asset");
  try {
    return CharacterInstance(std::make_unique<State>(std::move(asset), capacity));
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

Result<CharacterInstance> CharacterInstance::create(std::shared_ptr<const Character> character,
                                                    const CharacterAssetOptions& options,
                                                    const TornCapacity& capacity) {
  auto asset = CharacterAsset::create(std::move(character), options);
  if (!asset) return asset.error();
  return create(std::move(*asset), capacity);
}

Status CharacterInstance::prepare_to_tear() {
  const MemoryScope scope(state_->memory);
  return state_->prepare_to_tear();
}

Status CharacterInstance::pack() {
  const MemoryScope scope(state_->memory);
  if (!state_->torn) return {};
  if (Status status = state_->torn->model.pack(); !status) return status;
  if (state_->torn->particles)
    if (Status status = state_->torn->particles->pack(); !status) return status;
  state_->release_scratch();
  return {};
}

// ---- Operations.

Result<TearReport> CharacterInstance::tear(const ModelPose& pose, std::span<const Blade> stroke,
                                           const TearOptions& options, ChangeRecord* change) {
  const MemoryScope scope(state_->memory);
  return state_->change(change, [&](ChangeRecord* record) {
    return state_->torn->model.tear(pose, stroke, options, record);
  });
}

Result<TearReport> CharacterInstance::cut(const ModelPose& pose, const PlaneCut& cut,
                                          ChangeRecord* change) {
  const MemoryScope scope(state_->memory);
  return state_->change(
      change, [&](ChangeRecord* record) { return state_->torn->model.cut(pose, cut, record); });
}

Result<TearReport> CharacterInstance::drill(const ModelPose& pose, const Bore& bore,
                                            ChangeRecord* change) {
  const MemoryScope scope(state_->memory);
  return state_->change(
      change, [&](ChangeRecord* record) { return state_->torn->model.drill(pose, bore, record); });
}

Result<TearReport> CharacterInstance::weld(const ModelPose& pose, const Weld& weld,
                                           ChangeRecord* change) {
  const MemoryScope scope(state_->memory);
  return state_->change(
      change, [&](ChangeRecord* record) { return state_->torn->model.weld(pose, weld, record); });
}

Result<TearReport> CharacterInstance::suture(const ModelPose& pose, const Suture& suture,
                                             ChangeRecord* change) {
  const MemoryScope scope(state_->memory);
  return state_->change(change, [&](ChangeRecord* record) {
    return sunder::suture(state_->torn->model, pose, suture, record);
  });
}

Result<DetachedPiece> CharacterInstance::detach(const ModelPose& pose, const PiecePlace& place,
                                                const DetachOptions& options, ChangeRecord* change,
                                                PieceTissue* tissue) {
  const MemoryScope scope(state_->memory);
  return state_->change(change, [&](ChangeRecord* record) {
    Result<DetachedPiece> piece = sunder::detach(state_->torn->model, pose, place, options, record);
    if (piece && tissue != nullptr) state_->keep_tissue(*piece, *tissue);
    return piece;
  });
}

Status CharacterInstance::inherit_motion(const DetachedPiece& piece, const PieceTissue& tissue) {
  const MemoryScope scope(state_->memory);
  if (Status status = state_->require_torn(); !status) return status;
  if (body() == nullptr)
    return Status::failure(StatusCode::invalid_argument, kNone, "the instance has no soft body");
  try {
    state_->needs_draw = true;
    return body()->inherit_motion_from(scene::motions_of(piece, tissue, character(), *particles()));
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

Status CharacterInstance::undo(ChangeRecord* change) {
  const MemoryScope scope(state_->memory);
  return state_->change(change,
                        [&](ChangeRecord* record) { return state_->torn->model.undo(record); });
}

Status CharacterInstance::redo(ChangeRecord* change) {
  const MemoryScope scope(state_->memory);
  return state_->change(change,
                        [&](ChangeRecord* record) { return state_->torn->model.redo(record); });
}

Result<TearReport> CharacterInstance::apply(const Operation& operation,
                                            std::vector<ChangeRecord>* changes) {
  const MemoryScope scope(state_->memory);
  const auto play = [&](std::vector<ChangeRecord>* records) {
    return apply_operation(state_->torn->model, operation, records);
  };
  return state_->change_all(
      changes, play, [&](std::span<const ChangeRecord> made) { return state_->follow(made); });
}

Status CharacterInstance::begin_stroke(const ModelPose& pose, const Blade& blade,
                                       const TearOptions& options, const StrokeSampling& sampling) {
  const MemoryScope scope(state_->memory);
  if (Status status = state_->require_torn(); !status) return status;
  Result<TearStroke> begun =
      TearStroke::create(state_->torn->model, pose, blade, options, sampling);
  if (!begun) return begun.error();
  state_->torn->stroke.emplace(std::move(*begun));
  return {};
}

Result<TearReport> CharacterInstance::extend_stroke(const ModelPose& pose, const Blade& blade,
                                                    double seconds, ChangeRecord* change) {
  const MemoryScope scope(state_->memory);
  if (!is_in_stroke()) return no_stroke();
  return state_->change(change, [&](ChangeRecord* record) {
    return state_->torn->stroke->extend(pose, blade, seconds, record);
  });
}

Result<TearReport> CharacterInstance::end_stroke(ChangeRecord* change) {
  const MemoryScope scope(state_->memory);
  if (!is_in_stroke()) return no_stroke();
  Result<TearReport> report = state_->change(
      change, [&](ChangeRecord* record) { return state_->torn->stroke->end(record); });
  if (report) state_->torn->stroke.reset();
  return report;
}

Status CharacterInstance::cancel_stroke(ChangeRecord* change) {
  const MemoryScope scope(state_->memory);
  if (!is_in_stroke()) return no_stroke();
  Status status = state_->change(
      change, [&](ChangeRecord* record) { return state_->torn->stroke->cancel(record); });
  if (status) state_->torn->stroke.reset();
  return status;
}

Result<ForceTearingReport> CharacterInstance::tear_overstretched(
    const ForceTearingOptions& options, std::vector<ChangeRecord>* changes) {
  const MemoryScope scope(state_->memory);
  State& state = *state_;
  if (!body())
    return Status::failure(StatusCode::invalid_argument, kNone, "the instance has no soft body");
  if (state.pose.model_from_bone.empty())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the instance has no pose yet; call advance() first");
  const auto tear = [&](std::vector<ChangeRecord>* records) {
    return sunder::tear_overstretched(*state.torn->body, *state.torn->particles, state.torn->model,
                                      state.pose, options, records);
  };
  return state.change_all(changes, tear, [&](std::span<const ChangeRecord> made) -> Status {
    state.note(made);  // the particles have followed
    return {};
  });
}

Result<RefitJob> CharacterInstance::begin_refit(const WeightsOperation& wanted) {
  const MemoryScope scope(state_->memory);
  if (Status status = state_->require_torn(); !status) return status;
  return RefitJob::create(state_->torn->model, wanted);
}

Result<OperationJob> CharacterInstance::begin_operation(const Operation& operation) {
  const MemoryScope scope(state_->memory);
  return state_->begin_operation([&](OperationJob::Observer observer) {
    return OperationJob::create(state_->torn->model, operation, std::move(observer));
  });
}

Result<OperationJob> CharacterInstance::begin_detach(const DetachOperation& operation,
                                                     const DetachOptions& options) {
  const MemoryScope scope(state_->memory);
  return state_->begin_operation([&](OperationJob::Observer observer) {
    return OperationJob::create(state_->torn->model, operation, options, std::move(observer));
  });
}

Result<TearReport> CharacterInstance::swap_in(const OperationJob& job, ChangeRecord* change,
                                              PieceTissue* tissue) {
  const MemoryScope scope(state_->memory);
  if (job.poll() == OperationJob::State::failed) {
    state_->drop(job);
    return job.failure();
  }
  return state_->swap_in(job, change, tissue);
}

Result<WeightReport> CharacterInstance::swap_in(const RefitJob& job, ChangeRecord* change) {
  const MemoryScope scope(state_->memory);
  return state_->change(
      change, [&](ChangeRecord* record) { return job.swap_in(state_->torn->model, record); });
}

Status CharacterInstance::begin_wound_mask(std::uint32_t mesh, const WoundMaskOptions& options) {
  const MemoryScope scope(state_->memory);
  if (Status status = state_->require_torn(); !status) return status;
  try {
    if (!state_->wound_masks) state_->wound_masks = std::make_unique<scene::WoundMasks>();
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, mesh, "out of memory");
  }
  return state_->wound_masks->begin(state_->torn->model, mesh, options);
}

void CharacterInstance::end_wound_mask(std::uint32_t mesh) {
  if (state_->wound_masks) state_->wound_masks->end(mesh);
}

Result<CharacterInstance::PaintedWounds> CharacterInstance::wound_mask(std::uint32_t mesh) {
  const MemoryScope scope(state_->memory);
  if (!state_->torn || !state_->wound_masks)
    return Status::failure(StatusCode::not_found, mesh, "mesh %u has no wound mask", mesh);
  const Result<scene::WoundMasks::Taken> taken =
      state_->wound_masks->take(state_->torn->model, mesh);
  if (!taken) return taken.error();
  return PaintedWounds{taken->mask, taken->changed};
}

Result<const WoundMask*> CharacterInstance::peek_wound_mask(std::uint32_t mesh) {
  const MemoryScope scope(state_->memory);
  if (!state_->torn || !state_->wound_masks)
    return Status::failure(StatusCode::not_found, mesh, "mesh %u has no wound mask", mesh);
  return state_->wound_masks->peek(state_->torn->model, mesh);
}

Result<CompactMaps> CharacterInstance::compact() {
  const MemoryScope scope(state_->memory);
  State& state = *state_;
  if (Status status = state.require_torn(); !status) return status;
  try {
    // The new asset is made first, so that a failure changes nothing.
    Result<CompactMaps> maps = state.torn->model.compact();
    if (!maps) return maps;
    state.is_broken = true;  // until all parts agree again
    auto compacted = std::make_shared<const Character>(state.torn->model.character());
    auto asset = CharacterAsset::create(std::move(compacted), state.shared().options);
    if (!asset) return asset.error();
    auto fresh = std::make_unique<State>(std::move(*asset), state.capacity);
    fresh->pose = state.pose;
    fresh->needs_draw = true;
    if (Status status = fresh->require_torn(); !status) return status;
    state_ = std::move(fresh);
    return maps;
  } catch (const std::bad_alloc&) {
    return broken_for_lack_of_memory();
  }
}

// ---- Frames.

Status CharacterInstance::advance(const ModelPose& pose, double seconds,
                                  std::uint32_t settled_points) {
  const MemoryScope scope(state_->memory);
  State& state = *state_;
  if (state.is_broken) return broken_for_lack_of_memory();
  if (Status status = check_seconds(seconds); !status) return status;
  if (Status status = scene::check_pose(*state.shared().character, pose); !status) return status;
  const bool is_moved = !is_same_pose(pose, state.pose);
  try {
    state.pose.model_from_bone.reserve(pose.model_from_bone.size());
    state.pose.morph_weights.reserve(pose.morph_weights.size());
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
  if (SoftBody* const soft = body()) {
    state.needs_draw |= soft->needs_step();
    if (Status status = soft->step(state.torn->model, pose, seconds, settled_points); !status)
      return status;
  }
  if (!is_moved) return {};
  state.pose = pose;
  state.needs_draw = true;
  return {};
}

bool CharacterInstance::settle(std::uint32_t points) {
  const MemoryScope scope(state_->memory);
  if (particles() == nullptr || points == 0) return needs_settling();
  return state_->torn->particles->settle(state_->torn->model, points);
}

Status CharacterInstance::draw(const ParallelFor& parallel_for) {
  const MemoryScope scope(state_->memory);
  Status status = state_->draw(parallel_for);
  if (!status && state_->drawn)
    for (scene::InstanceMesh& mesh : state_->drawn->meshes) mesh.forget();
  return status;
}

Status CharacterInstance::set_target(std::uint32_t mesh, const VertexTarget& target) {
  const MemoryScope scope(state_->memory);
  SUNDER_ASSERT(mesh < state_->shared().meshes.size());
  try {
    if (Status status = state_->require_drawn(); !status) return status;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
  state_->drawn->meshes[mesh].set_target(target);
  state_->needs_draw = true;
  return {};
}

PosedMesh CharacterInstance::mesh(std::uint32_t mesh, std::uint64_t seen) {
  const MemoryScope scope(state_->memory);
  SUNDER_ASSERT(mesh < state_->shared().meshes.size());
  if (!state_->drawn) return {};
  try {
    const bool is_own = state_->is_own(seen);
    PosedMesh posed = state_->drawn->meshes[mesh].posed(is_own ? seen : 0);
    posed.epoch = posed.ranges.empty() ? seen : state_->epoch;
    if (!is_own && !posed.ranges.empty()) posed.initial_triangles = state_->asset->triangles(mesh);
    return posed;
  } catch (const std::bad_alloc&) {
    return {};
  }
}

const std::shared_ptr<const CharacterAsset>& CharacterInstance::asset() const {
  return state_->asset;
}
const Character& CharacterInstance::character() const { return state_->character(); }
const TornModel* CharacterInstance::model() const {
  return state_->torn ? &state_->torn->model : nullptr;
}
const ModelPose& CharacterInstance::pose() const { return state_->pose; }
SoftBody* CharacterInstance::body() {
  return state_->torn && state_->torn->body ? &*state_->torn->body : nullptr;
}
const SoftBody* CharacterInstance::body() const {
  return state_->torn && state_->torn->body ? &*state_->torn->body : nullptr;
}
VertexDisplacements CharacterInstance::displacements(std::uint32_t mesh) {
  const MemoryScope scope(state_->memory);
  SUNDER_ASSERT(mesh < state_->shared().meshes.size());
  return state_->displacements(mesh);
}
const ParticleSet* CharacterInstance::particles() const {
  return state_->torn && state_->torn->particles ? &*state_->torn->particles : nullptr;
}
Result<CharacterInstance::TissueState> CharacterInstance::tissue() const {
  if (body() == nullptr)
    return Status::failure(StatusCode::invalid_argument, kNone, "the instance has no soft body");
  Result<StateArrays> particles = state_->torn->particles->save();
  if (!particles) return particles.error();
  Result<StateArrays> of_body = body()->save();
  if (!of_body) return of_body.error();
  return TissueState{std::move(*particles), std::move(*of_body)};
}

Status CharacterInstance::restore_tissue(const TissueState& wanted) {
  const MemoryScope scope(state_->memory);
  State& state = *state_;
  if (Status status = state.require_torn(); !status) return status;
  const std::optional<SoftTissue>& soft = state.shared().options.soft;
  if (!soft) return Status::failure(StatusCode::invalid_argument, kNone, "the asset is not soft");
  Result<ParticleSet> set =
      ParticleSet::restore(state.shared().particles, state.torn->model, wanted.particles);
  if (!set) return set.error();
  try {
    return state.restore_tissue(*soft, std::move(*set), wanted.body);
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

bool CharacterInstance::is_in_stroke() const {
  return state_->torn && state_->torn->stroke.has_value();
}
std::uint32_t CharacterInstance::drawn_vertices() const {
  std::uint32_t count = 0;
  if (state_->drawn)
    for (const scene::InstanceMesh& mesh : state_->drawn->meshes) count += mesh.drawn_vertices();
  return count;
}
std::size_t CharacterInstance::memory_bytes() const { return state_->memory_bytes(); }
bool CharacterInstance::needs_draw() const { return state_->needs_draw; }
bool CharacterInstance::needs_settling() const {
  return particles() != nullptr && !particles()->is_settled();
}
bool CharacterInstance::needs_step() const {
  const SoftBody* const soft = body();
  return soft != nullptr && soft->needs_step();
}

}  // namespace sunder
