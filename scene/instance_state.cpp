#include "scene/instance_state.h"

#include <atomic>
#include <new>

#include "scene/actor/piece_tissue.h"

namespace sunder {

Status broken_for_lack_of_memory() {
  return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory; make a new instance");
}

CharacterInstance::State::State(std::shared_ptr<const CharacterAsset> of, const TornCapacity& room)
    : asset(std::move(of)), capacity(room) {
  static std::atomic<std::uint64_t> newest = 0;
  epoch = ++newest << 32;
}

Status CharacterInstance::State::require_torn() {
  if (is_broken) return broken_for_lack_of_memory();
  return torn ? Status() : make_torn(shared().tissue.has_value());
}

Status CharacterInstance::State::make_torn(bool is_soft) {
  try {
    Result<TornModel> model = TornModel::create(shared().torn, capacity);
    if (!model) return model.error();
    if (Status status = model->set_weights(shared().options.weights); !status) return status;
    auto parts = std::make_unique<scene::TornParts>(std::move(*model));
    if (is_soft)
      if (Status status = parts->make_soft(*shared().tissue, shared().particles); !status)
        return status;
    torn = std::move(parts);
    return {};
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

Status CharacterInstance::State::prepare_model() {
  if (Status status = require_torn(); !status) return status;
  if (torn->model.is_packed())
    if (Status status = shared().torn->prepare(1, capacity); !status) return status;
  return torn->model.unpack();
}

Status CharacterInstance::State::prepare_to_tear() {
  if (Status status = prepare_model(); !status) return status;
  return torn->particles ? torn->particles->prepare_to_follow() : Status();
}

Status CharacterInstance::State::restore_tissue(const SoftTissue& soft, ParticleSet of_instance,
                                                const StateArrays& of_body) {
  auto set = std::make_unique<ParticleSet>(std::move(of_instance));
  Result<SoftBody> body = scene::make_body(soft, torn->model.source(), *set);
  if (!body) return body.error();
  if (Status status = body->restore(of_body); !status) return status;
  torn->take(std::move(set), std::move(*body));
  needs_draw = true;
  return {};
}

Status CharacterInstance::State::require_drawn() {
  if (drawn) return {};
  const Character& source = *shared().character;
  auto parts = std::make_unique<DrawnParts>();
  for (const Skin& skin : source.skins) {
    Result<BonePalette> made = BonePalette::create(
        skin.bones.size(), source.rest_morph_weights.size(), shared().options.method);
    if (!made) return made.error();
    parts->palettes.push_back(std::move(*made));
  }
  parts->meshes.reserve(source.meshes.size());
  for (Index m = 0; m < source.meshes.size(); ++m) {
    const Index count = source.meshes[m].vertex_count();
    const Index room = capacity.is_fixed() ? capacity.vertices
                       : torn              ? scene::InstanceMesh::room_for_tears(count)
                                           : 0;
    parts->meshes.emplace_back(shared().meshes[m], count, room, shared().options.unit_length);
  }
  if (torn)
    for (Index m = 0; m < parts->meshes.size(); ++m)
      parts->meshes[m].note_all(source.meshes[m], torn->model.character().meshes[m], epoch + 1);
  drawn = std::move(parts);
  return {};
}

void CharacterInstance::State::note(std::span<const ChangeRecord> changes) noexcept {
  if (wound_masks) wound_masks->follow(torn->model, changes);
  for (const ChangeRecord& change : changes)
    for (const MeshChange& of_mesh : change.meshes) {
      needs_draw = true;
      if (drawn) drawn->meshes[of_mesh.mesh].note(of_mesh, epoch + 1);
    }
}

Status CharacterInstance::State::follow(std::span<const ChangeRecord> changes) {
  note(changes);
  if (!torn->particles) return {};
  Status status = torn->particles->follow(torn->model, changes);
  is_broken = !status;
  return status;
}

void CharacterInstance::State::keep_tissue(const DetachedPiece& piece,
                                           PieceTissue& tissue) noexcept {
  tissue = {};
  if (!torn->body) return;
  try {
    (void)torn->body->displacements();  // of the particles as earlier operations left them
    tissue = scene::tissue_of(piece, *torn->particles, *torn->body);
  } catch (const std::bad_alloc&) {
    tissue = {};
  }
}

Result<OperationJob> CharacterInstance::State::begin_operation(
    const std::function<Result<OperationJob>(OperationJob::Observer)>& create) {
  if (Status status = require_torn(); !status) return status;
  begun.reset();
  try {
    std::optional<ParticleFork> fork;
    if (torn->particles) {
      Result<ParticleFork> made = ParticleFork::create(*torn->particles, torn->model);
      if (!made) return made.error();
      fork.emplace(std::move(*made));
    }
    const auto prepared =
        std::make_shared<scene::PreparedSwap>(asset, shared().meshes, std::move(fork));
    Result<OperationJob> job =
        create([prepared](const TornModel& replica, std::span<const ChangeRecord> changes) {
          prepared->prepare(replica, changes);
        });
    if (job) begun.emplace(scene::BegunOperation{*job, prepared});
    return job;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

void CharacterInstance::State::drop(const OperationJob& job) noexcept {
  if (!begun || begun->job != job) return;
  begun->prepared->cancel();
  begun.reset();
}

Result<TearReport> CharacterInstance::State::swap_in(const OperationJob& job, ChangeRecord* change,
                                                     PieceTissue* tissue) {
  PieceTissue motion;
  if (tissue != nullptr && job.piece() && torn) keep_tissue(*job.piece(), motion);
  Result<TearReport> report = swap_in(job, change);
  if (report && tissue != nullptr) *tissue = std::move(motion);
  return report;
}

Result<TearReport> CharacterInstance::State::swap_in(const OperationJob& job,
                                                     ChangeRecord* change) {
  if (!begun || begun->job != job)
    return this->change(change,
                        [&](ChangeRecord* record) { return job.swap_in(torn->model, record); });
  ChangeRecord& record = change != nullptr ? *change : scratch_;
  const std::uint64_t before = torn->model.newest_operation();
  Result<TearReport> report = job.swap_in(torn->model, &record);
  if (!report) return report;
  const std::shared_ptr<scene::PreparedSwap> prepared = std::move(begun->prepared);
  begun.reset();
  if (torn->model.newest_operation() == before) {  // it missed
    prepared->cancel();
    return report;
  }
  note({&record, 1});
  if (drawn) prepared->give(drawn->meshes);
  if (!torn->particles || prepared->give(*torn->particles, torn->model)) return report;
  const Status status = torn->particles->follow(torn->model, {&record, 1});
  is_broken = !status;
  return status ? report : Result<TearReport>(status);
}

Status CharacterInstance::State::set_palettes() {
  const std::vector<Skin>& skins = shared().character->skins;
  for (std::size_t i = 0; i < skins.size(); ++i)
    if (Status status = drawn->palettes[i].set(skins[i], pose); !status) return status;
  return {};
}

/// Applies tears to a mesh. A packed model is not looked at if there were none.
Status CharacterInstance::State::update_mesh(Index mesh) {
  scene::InstanceMesh& posed = drawn->meshes[mesh];
  if (!posed.needs_update()) return {};
  if (!torn) return posed.update(shared().character->meshes[mesh], nullptr, epoch + 1);
  const TornModel& model = torn->model;
  return posed.update(model.character().meshes[mesh], &model.influence_positions(mesh), epoch + 1);
}

Status CharacterInstance::State::draw_mesh(Index mesh, const ParallelFor& parallel_for) {
  if (Status status = update_mesh(mesh); !status) return status;
  scene::InstanceMesh& posed = drawn->meshes[mesh];
  scene::InstanceMesh::Input input = {drawn->palettes[shared().character->meshes[mesh].skin],
                                      nullptr, parallel_for, epoch + 1};
  VertexDisplacements displaced;
  if (shared().options.poses_vertices) displaced = displacements(mesh);
  if (displaced.moved.empty()) return posed.draw(input);
  if (posed.has_directions()) {
    displaced.gradients = torn->particles->gradients(torn->model);
    displaced.model_from_gradient = torn->body->rotations();
  }
  input.displaced = &displaced;
  return posed.draw(input);
}

VertexDisplacements CharacterInstance::State::displacements(Index mesh) {
  VertexDisplacements displaced;
  if (!torn || !torn->body) return displaced;
  displaced.moved = torn->body->moved_vertices(torn->model, mesh);
  displaced.vertex_rows = torn->particles->vertex_points(mesh);
  displaced.influences = torn->particles->influences();
  displaced.displacements = torn->body->displacements();
  return displaced;
}

Status CharacterInstance::State::draw(const ParallelFor& parallel_for) {
  if (is_broken) return broken_for_lack_of_memory();
  if (pose.model_from_bone.empty())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the instance has no pose yet; call advance() first");
  if (!needs_draw) return {};
  try {
    if (Status status = require_drawn(); !status) return status;
    if (shared().options.poses_vertices)
      if (Status status = set_palettes(); !status) return status;
    for (Index mesh = 0; mesh < drawn->meshes.size(); ++mesh)
      if (Status status = draw_mesh(mesh, parallel_for); !status) return status;
    ++epoch;
    needs_draw = false;
    return {};
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

std::size_t CharacterInstance::State::memory_bytes() const {
  std::size_t bytes = sizeof(*this) + pose.model_from_bone.capacity() * sizeof(Affine3d) +
                      pose.morph_weights.capacity() * sizeof(float);
  if (torn) {
    const TornMemory of_model = torn->model.memory_bytes();
    bytes += sizeof(*torn) + of_model.own + of_model.reserved;
    if (torn->body) bytes += torn->particles->memory_bytes() + torn->body->memory_bytes();
  }
  if (!drawn) return bytes;
  bytes += sizeof(*drawn);
  for (const Skin& skin : shared().character->skins)
    bytes += sizeof(BonePalette) + skin.bones.size() * sizeof(Affine3f);
  for (const scene::InstanceMesh& mesh : drawn->meshes) bytes += sizeof(mesh) + mesh.memory_bytes();
  return bytes;
}

}  // namespace sunder
