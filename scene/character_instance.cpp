#include <sunder/scene/character_instance.h>
#include <sunder/skinning/pose.h>

#include <cmath>
#include <new>
#include <utility>

#include "scene/instance_mesh.h"

namespace sunder {
namespace {

Status out_of_memory() {
  return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory; make a new instance");
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

}  // namespace

struct CharacterInstance::State {
  TornModel model;
  std::optional<TearStroke> stroke;  // refers to the model
  std::optional<ParticleSet> particles;
  std::optional<SoftBody> body;       // refers to the particles
  std::vector<BonePalette> palettes;  ///< One per skin.
  std::vector<scene::InstanceMesh> meshes;
  CharacterInstanceOptions options;
  ModelPose pose;
  ChangeRecord scratch;    ///< For callers that want no record.
  bool is_broken = false;  ///< Memory ran out between two parts, which no longer agree.

  State(TornModel made, const CharacterInstanceOptions& wanted)
      : model(std::move(made)), options(wanted) {}

  /// Makes all parts but the model, for the model as it is.
  Status make_parts();
  Status make_soft(const SoftTissue& soft);
  Status make_meshes();
  /// Lets the meshes know.
  void note(std::span<const ChangeRecord> changes) noexcept;
  /// Lets the meshes and the particles know.
  Status follow(std::span<const ChangeRecord> changes);
  Status deform(Index mesh);
  Status pose_meshes(const ModelPose& wanted);

  /// Makes one call that tears, and passes its record on to the particles and the meshes.
  template <class Call>
  auto change(ChangeRecord* wanted, Call call) -> decltype(call(wanted)) {
    if (is_broken) return out_of_memory();
    ChangeRecord& record = wanted != nullptr ? *wanted : scratch;
    auto outcome = call(&record);
    if (outcome)
      if (Status status = follow({&record, 1}); !status) return status;
    return outcome;
  }

  /// Makes a call that appends its records to a list. Records made before a failure are passed on
  /// too.
  template <class Call, class PassOn>
  auto change_all(std::vector<ChangeRecord>* wanted, Call call, PassOn pass_on)
      -> decltype(call(wanted)) {
    if (is_broken) return out_of_memory();
    std::vector<ChangeRecord> unwanted;
    std::vector<ChangeRecord>& records = wanted != nullptr ? *wanted : unwanted;
    const std::size_t before = records.size();
    auto outcome = call(&records);
    const auto made = std::span<const ChangeRecord>(records).subspan(before);
    if (outcome || !made.empty())
      if (Status status = pass_on(made); !status) return status;
    return outcome;
  }
};

Status CharacterInstance::State::make_parts() {
  if (Status status = make_meshes(); !status) return status;
  return options.soft ? make_soft(*options.soft) : Status();
}

Status CharacterInstance::State::make_soft(const SoftTissue& soft) {
  // At rest lengths are metres; bind space may have any unit, such as that of quantised positions.
  const Result<ModelPose> rest = rest_pose(model.character());
  if (!rest) return rest.error();
  Result<ParticleSet> divided = ParticleSet::create(model, *rest, soft.decomposition);
  if (!divided) return divided.error();
  body.reset();
  particles.emplace(std::move(*divided));
  Result<SoftBody> made = SoftBody::create(*particles, *rest, soft.materials, soft.body);
  if (!made) return made.error();
  body.emplace(std::move(*made));
  return {};
}

Status CharacterInstance::State::make_meshes() {
  const Character& character = model.character();
  palettes.clear();
  meshes.clear();
  for (const Skin& skin : character.skins) {
    Result<BonePalette> made =
        BonePalette::create(skin.bones.size(), character.rest_morph_weights.size(), options.method);
    if (!made) return made.error();
    palettes.push_back(std::move(*made));
  }
  for (const Mesh& mesh : character.meshes) {
    Result<scene::InstanceMesh> made =
        scene::InstanceMesh::create(mesh, character.skins[mesh.skin].bones.size(), options);
    if (!made) return made.error();
    meshes.push_back(std::move(*made));
  }
  return {};
}

void CharacterInstance::State::note(std::span<const ChangeRecord> changes) noexcept {
  for (const ChangeRecord& change : changes)
    for (const MeshChange& of_mesh : change.meshes) meshes[of_mesh.mesh].note(of_mesh);
}

Status CharacterInstance::State::follow(std::span<const ChangeRecord> changes) {
  note(changes);
  if (!particles) return {};
  Status status = particles->follow(model, changes);
  is_broken = !status;
  return status;
}

Status CharacterInstance::State::deform(Index mesh) {
  const Mesh& torn = model.character().meshes[mesh];
  scene::InstanceMesh& posed = meshes[mesh];
  if (Status status = posed.update(torn, model.influence_positions(mesh)); !status) return status;
  const BonePalette& palette = palettes[torn.skin];
  const std::span<const IndexRange> moved =
      body ? body->moved_vertices(model, mesh) : std::span<const IndexRange>();
  if (moved.empty()) return posed.deform(palette, options.parallel_for, nullptr);
  VertexDisplacements displaced{particles->vertex_points(mesh),
                                particles->influences(),
                                body->displacements(),
                                moved,
                                {},
                                body->rotations()};
  if (posed.has_directions()) displaced.gradients = particles->gradients(model);
  return posed.deform(palette, options.parallel_for, &displaced);
}

Status CharacterInstance::State::pose_meshes(const ModelPose& wanted) {
  try {
    pose.model_from_bone.reserve(wanted.model_from_bone.size());
    pose.morph_weights.reserve(wanted.morph_weights.size());
    for (Index mesh = 0; mesh < meshes.size(); ++mesh)
      if (Status status = deform(mesh); !status) return status;
    pose = wanted;
    for (Index mesh = 0; mesh < meshes.size(); ++mesh)
      meshes[mesh].publish(model.character().meshes[mesh]);
    return {};
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

CharacterInstance::CharacterInstance(std::unique_ptr<State> state) : state_(std::move(state)) {}
CharacterInstance::~CharacterInstance() = default;
CharacterInstance::CharacterInstance(CharacterInstance&&) noexcept = default;
CharacterInstance& CharacterInstance::operator=(CharacterInstance&&) noexcept = default;

Result<CharacterInstance> CharacterInstance::create(std::shared_ptr<const Character> character,
                                                    const CharacterInstanceOptions& options) {
  try {
    Result<TornModel> model = TornModel::create(std::move(character), options.capacity);
    if (!model) return model.error();
    if (Status status = model->set_weights(options.weights); !status) return status;
    auto state = std::make_unique<State>(std::move(*model), options);
    if (Status status = state->make_parts(); !status) return status;
    return CharacterInstance(std::move(state));
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

// ---- Operations.

Result<TearReport> CharacterInstance::tear(const ModelPose& pose, std::span<const Blade> stroke,
                                           const TearOptions& options, ChangeRecord* change) {
  return state_->change(change, [&](ChangeRecord* record) {
    return state_->model.tear(pose, stroke, options, record);
  });
}

Result<TearReport> CharacterInstance::cut(const ModelPose& pose, const PlaneCut& cut,
                                          ChangeRecord* change) {
  return state_->change(change,
                        [&](ChangeRecord* record) { return state_->model.cut(pose, cut, record); });
}

Result<TearReport> CharacterInstance::drill(const ModelPose& pose, const Bore& bore,
                                            ChangeRecord* change) {
  return state_->change(
      change, [&](ChangeRecord* record) { return state_->model.drill(pose, bore, record); });
}

Result<DetachedPiece> CharacterInstance::detach(const ModelPose& pose, const PiecePlace& place,
                                                const DetachOptions& options,
                                                ChangeRecord* change) {
  return state_->change(change, [&](ChangeRecord* record) {
    return sunder::detach(state_->model, pose, place, options, record);
  });
}

Status CharacterInstance::undo(ChangeRecord* change) {
  return state_->change(change, [&](ChangeRecord* record) { return state_->model.undo(record); });
}

Status CharacterInstance::redo(ChangeRecord* change) {
  return state_->change(change, [&](ChangeRecord* record) { return state_->model.redo(record); });
}

Result<TearReport> CharacterInstance::apply(const Operation& operation,
                                            std::vector<ChangeRecord>* changes) {
  const auto play = [&](std::vector<ChangeRecord>* records) {
    return apply_operation(state_->model, operation, records);
  };
  return state_->change_all(
      changes, play, [&](std::span<const ChangeRecord> made) { return state_->follow(made); });
}

Status CharacterInstance::begin_stroke(const ModelPose& pose, const Blade& blade,
                                       const TearOptions& options, const StrokeSampling& sampling) {
  if (state_->is_broken) return out_of_memory();
  Result<TearStroke> begun = TearStroke::create(state_->model, pose, blade, options, sampling);
  if (!begun) return begun.error();
  state_->stroke.emplace(std::move(*begun));
  return {};
}

Result<TearReport> CharacterInstance::extend_stroke(const ModelPose& pose, const Blade& blade,
                                                    double seconds, ChangeRecord* change) {
  if (!state_->stroke)
    return Status::failure(StatusCode::invalid_argument, kNone, "no stroke is in progress");
  return state_->change(change, [&](ChangeRecord* record) {
    return state_->stroke->extend(pose, blade, seconds, record);
  });
}

Result<TearReport> CharacterInstance::end_stroke(ChangeRecord* change) {
  if (!state_->stroke)
    return Status::failure(StatusCode::invalid_argument, kNone, "no stroke is in progress");
  Result<TearReport> report =
      state_->change(change, [&](ChangeRecord* record) { return state_->stroke->end(record); });
  if (report) state_->stroke.reset();
  return report;
}

Status CharacterInstance::cancel_stroke(ChangeRecord* change) {
  if (!state_->stroke)
    return Status::failure(StatusCode::invalid_argument, kNone, "no stroke is in progress");
  Status status =
      state_->change(change, [&](ChangeRecord* record) { return state_->stroke->cancel(record); });
  if (status) state_->stroke.reset();
  return status;
}

Result<ForceTearingReport> CharacterInstance::tear_overstretched(
    const ForceTearingOptions& options, std::vector<ChangeRecord>* changes) {
  State& state = *state_;
  if (!state.body)
    return Status::failure(StatusCode::invalid_argument, kNone, "the instance is not soft");
  if (state.pose.model_from_bone.empty())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the instance has no pose yet; call advance() first");
  const auto tear = [&](std::vector<ChangeRecord>* records) {
    return sunder::tear_overstretched(*state.body, *state.particles, state.model, state.pose,
                                      options, records);
  };
  return state.change_all(changes, tear, [&](std::span<const ChangeRecord> made) -> Status {
    state.note(made);  // the particles have followed
    return {};
  });
}

Result<RefitJob> CharacterInstance::begin_refit(const WeightsOperation& wanted) {
  return RefitJob::create(state_->model, wanted);
}

Result<WeightReport> CharacterInstance::swap_in(const RefitJob& job, ChangeRecord* change) {
  return state_->change(change,
                        [&](ChangeRecord* record) { return job.swap_in(state_->model, record); });
}

Result<CompactMaps> CharacterInstance::compact() {
  State& state = *state_;
  if (state.is_broken) return out_of_memory();
  Result<CompactMaps> maps = state.model.compact();
  if (!maps) return maps;
  state.is_broken = true;  // until all parts agree again
  try {
    if (Status status = state.make_parts(); !status) return status;
    state.is_broken = false;
    return maps;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

// ---- Frames.

Status CharacterInstance::advance(const ModelPose& pose, double seconds) {
  State& state = *state_;
  if (state.is_broken) return out_of_memory();
  if (Status status = check_seconds(seconds); !status) return status;
  const std::vector<Skin>& skins = state.model.character().skins;
  // The palettes check the pose. Only frames that succeed read them, so a failing one may leave
  // them half set.
  for (std::size_t i = 0; i < skins.size(); ++i)
    if (Status status = state.palettes[i].set(skins[i], pose); !status) return status;
  if (state.body)
    if (Status status = state.body->step(state.model, pose, seconds); !status) return status;
  Status status = state.pose_meshes(pose);
  if (!status)
    for (scene::InstanceMesh& mesh : state.meshes) mesh.forget();
  return status;
}

PosedMesh CharacterInstance::mesh(std::uint32_t mesh) const {
  SUNDER_ASSERT(mesh < state_->meshes.size());
  return state_->meshes[mesh].posed(state_->model.character().meshes[mesh]);
}

const TornModel& CharacterInstance::model() const { return state_->model; }
const ModelPose& CharacterInstance::pose() const { return state_->pose; }
SoftBody* CharacterInstance::body() { return state_->body ? &*state_->body : nullptr; }
const SoftBody* CharacterInstance::body() const { return state_->body ? &*state_->body : nullptr; }
const ParticleSet* CharacterInstance::particles() const {
  return state_->particles ? &*state_->particles : nullptr;
}

}  // namespace sunder
