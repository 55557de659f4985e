#include <sunder/core/memory_scope.h>

#include <algorithm>
#include <array>
#include <new>

#include "scene/instance_replay.h"
#include "scene/saved_instance.h"
#include "scene/scene_state.h"
#include "scene/snapshot/asset_digest.h"
#include "scene/snapshot/checksum.h"
#include "scene/snapshot/restore_budget.h"

namespace sunder {
namespace scene {
namespace {

constexpr std::uint32_t kMagic = 0x444E5553;  // "SUND"
constexpr std::uint32_t kVersion = 3;
/// The magic number, the version, and the checksum of what follows.
constexpr std::size_t kHeaderBytes = 4 + 4 + 8;
/// The times of a scene, seconds: 30,000 years, so that adding a frame goes on.
constexpr double kMostSeconds = 1e12;

/// All but the digest of the asset, which says how poses are read.
template <class Archive>
void transfer_instance(Archive& archive, SavedInstance& of) {
  auto& [asset, is_prepared, done, undone, tissue, actor] = of;
  archive(is_prepared, done, undone, tissue, actor);
}

Status broken(const SnapshotReader& reader) {
  return Status::failure(StatusCode::malformed_file, static_cast<Index>(reader.offset()),
                         "the snapshot is damaged at byte %zu: %s", reader.offset(),
                         reader.fault());
}

using Assets = std::span<const std::shared_ptr<const CharacterAsset>>;

/// Finds assets by their digests.
class AssetTable {
 public:
  explicit AssetTable(Assets assets) {
    for (const auto& asset : assets)
      if (asset) entries_.push_back({digest_of(*asset), asset});
  }
  [[nodiscard]] std::shared_ptr<const CharacterAsset> find(std::uint64_t digest) const {
    for (const auto& [of_asset, asset] : entries_)
      if (of_asset == digest) return asset;
    return nullptr;
  }

 private:
  struct Entry {
    std::uint64_t digest;
    std::shared_ptr<const CharacterAsset> asset;
  };
  std::vector<Entry> entries_;
};

Result<SavedInstance> describe(const Actor& actor) {
  const CharacterInstance& of = actor.instance;
  if (of.is_in_stroke())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "a stroke is in progress; end or cancel it first");
  if (actor.commands.background_count() > 0 || actor.commands.has_waiting())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "commands run in the background; update until they are done");
  SavedInstance saved;
  saved.asset = digest_of(*of.asset());
  saved.actor = actor.state();
  saved.is_prepared = of.model() != nullptr;
  if (!saved.is_prepared) return saved;
  Result<std::vector<Operation>> done = of.model()->history();
  if (!done) return done.error();
  Result<std::vector<Operation>> undone = of.model()->undone_operations();
  if (!undone) return undone.error();
  saved.done = std::move(*done);
  saved.undone = std::move(*undone);
  if (of.body() == nullptr) return saved;
  Result<CharacterInstance::TissueState> tissue = of.tissue();
  if (!tissue) return tissue.error();
  saved.tissue = std::move(*tissue);
  return saved;
}

Status replay(const SavedInstance& saved, const RestoreBudget& budget,
              CharacterInstance& instance) {
  if (!saved.is_prepared) return {};
  InstanceReplay replayed(instance);
  if (Status status = replayed.begin(); !status) return status;
  if (Status status = budget.check_memory(instance.memory_bytes()); !status) return status;
  for (const std::vector<Operation>* operations : {&saved.done, &saved.undone})
    for (const Operation& operation : *operations) {
      if (Status status = replayed.apply(operation); !status) return status;
      if (Status status = budget.check_memory(instance.memory_bytes()); !status) return status;
    }
  for (std::size_t i = 0; i < saved.undone.size(); ++i)
    if (Status status = replayed.undo(); !status) return status;
  return {};
}

Status damaged(const char* what) {
  return Status::failure(StatusCode::malformed_file, kNone, "the snapshot is damaged: %s", what);
}

/// Whether the parts of an instance go together.
Status check_parts(const SavedInstance& saved, const CharacterInstance& made) {
  if (!saved.is_prepared && !(saved.done.empty() && saved.undone.empty()))
    return damaged("an instance without a torn model has operations");
  if (saved.tissue.has_value() != (saved.is_prepared && made.asset()->options().soft))
    return damaged("an instance has tissue where there is none, or none where there is some");
  if (saved.is_prepared && (made.model()->undo_count() != saved.done.size() ||
                            made.model()->redo_count() != saved.undone.size()))
    return damaged("an operation of an instance does nothing");
  return {};
}

/// Makes an instance as it was saved.
Result<std::unique_ptr<Actor>> revive(const SavedInstance& saved,
                                      const std::shared_ptr<const CharacterAsset>& asset,
                                      double now, RestoreBudget& budget) {
  if (Status status = budget.take_operations(saved.done.size() + saved.undone.size()); !status)
    return status;
  Result<CharacterInstance> instance = CharacterInstance::create(asset, budget.capacity());
  if (!instance) return instance.error();
  if (Status status = replay(saved, budget, *instance); !status) return status;
  if (Status status = check_parts(saved, *instance); !status) return status;
  auto actor = std::make_unique<Actor>(std::move(*instance), saved.actor.is_visible, 0.0);
  if (Status status = actor->restore(saved.actor, now); !status) return status;
  if (saved.tissue)
    if (Status status = actor->instance.restore_tissue(*saved.tissue); !status) return status;
  if (saved.actor.is_visible)
    if (Status status = InstanceReplay(actor->instance).draw(); !status) return status;
  if (Status status = budget.take_memory(actor->memory_bytes()); !status) return status;
  return actor;
}

Status in_slot(std::size_t slot, const Status& status) {
  return Status::failure(status.code(), static_cast<Index>(slot), "instance %zu: %s", slot,
                         status.text().data());
}

/// Reads one slot. @param now  time of the scene. @param slot  without an actor if it is free.
Status read_slot(SnapshotReader& reader, const AssetTable& assets, double now,
                 RestoreBudget& budget, Slot& slot) {
  bool has_instance = false;
  reader(slot.generation, has_instance);
  if (reader.has_failed()) return broken(reader);
  if (!has_instance) return {};
  SavedInstance saved;
  reader(saved.asset);
  const std::shared_ptr<const CharacterAsset> asset = assets.find(saved.asset);
  if (!asset)
    return reader.has_failed()
               ? broken(reader)
               : Status::failure(StatusCode::not_found, kNone,
                                 "none of the assets is its character (digest %016llx)",
                                 static_cast<unsigned long long>(saved.asset));
  PoseMemory poses(asset->character(), {});
  reader.poses = &poses;
  reader.limit_memory(budget.memory());
  transfer_instance(reader, saved);
  if (reader.is_too_large()) return budget.check_memory(budget.memory() + 1);
  if (reader.has_failed()) return broken(reader);
  Result<std::unique_ptr<Actor>> actor = revive(saved, asset, now, budget);
  if (!actor) return actor.error();
  slot.actor = std::move(*actor);
  slot.actor->set_origins(std::move(poses.read_origins()));
  return {};
}

/// The head of a snapshot that this build reads, and whose bytes are those that were written.
Status check_header(std::span<const std::byte> snapshot) {
  SnapshotReader reader(snapshot);
  std::uint32_t magic = 0, version = 0;
  std::uint64_t checksum = 0;
  reader(magic, version, checksum);
  if (magic != kMagic)
    return Status::failure(StatusCode::unsupported_format, 0, "this is not a snapshot of a scene");
  if (version != kVersion)
    return Status::failure(StatusCode::unsupported_format, 4,
                           "the snapshot has version %u; this build reads %u", version, kVersion);
  if (reader.has_failed()) return broken(reader);
  if (checksum_of(snapshot.subspan(kHeaderBytes)) != checksum)
    return Status::failure(StatusCode::malformed_file, 8,
                           "the snapshot is damaged: its checksum is not that of its bytes");
  return {};
}

/// Each slot has an instance, or is listed once as free.
Status check_slots(std::span<const Slot> slots, std::span<const Index> free) {
  std::vector<bool> is_free(slots.size(), false);
  for (const Index slot : free) {
    if (slot >= slots.size() || slots[slot].actor || is_free[slot])
      return Status::failure(StatusCode::malformed_file, slot,
                             "the snapshot is damaged: slot %u is not free", slot);
    is_free[slot] = true;
  }
  for (std::size_t i = 0; i < slots.size(); ++i)
    if (!slots[i].actor && !is_free[i])
      return Status::failure(StatusCode::malformed_file, static_cast<Index>(i),
                             "the snapshot is damaged: slot %zu is neither free nor used", i);
  return {};
}

/// Writes the checksum into a snapshot that is complete.
void seal(std::vector<std::byte>& snapshot) {
  const std::uint64_t checksum = checksum_of(std::span(snapshot).subspan(kHeaderBytes));
  for (std::size_t i = 0; i < 8; ++i) snapshot[8 + i] = static_cast<std::byte>(checksum >> (8 * i));
}

}  // namespace
}  // namespace scene

Result<std::vector<std::byte>> Scene::save() const {
  try {
    scene::SnapshotWriter writer;
    auto magic = scene::kMagic, version = scene::kVersion;
    auto slots = static_cast<Index>(state_->slots.size());
    std::uint64_t frame = state_->stats.frame, checksum = 0;
    double now = state_->now;
    writer(magic, version, checksum, now, frame, state_->free_slots, slots);
    for (std::size_t i = 0; i < state_->slots.size(); ++i) {
      scene::Slot& slot = state_->slots[i];
      bool has_instance = slot.actor != nullptr;
      writer(slot.generation, has_instance);
      if (!has_instance) continue;
      Result<scene::SavedInstance> saved = scene::describe(*slot.actor);
      if (!saved) return scene::in_slot(i, saved.error());
      scene::PoseMemory poses(slot.actor->instance.asset()->character(), slot.actor->origins());
      writer.poses = &poses;
      writer(saved->asset);
      scene::transfer_instance(writer, *saved);
    }
    scene::seal(writer.bytes());
    return std::move(writer.bytes());
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

struct LoadedSnapshot::Data {
  std::vector<scene::Slot> slots;
  std::vector<Index> free_slots;
  double now = 0;
  std::uint64_t frame = 0;
  bool is_taken = false;
};

LoadedSnapshot::LoadedSnapshot(std::unique_ptr<Data> data) : data_(std::move(data)) {}
LoadedSnapshot::~LoadedSnapshot() = default;
LoadedSnapshot::LoadedSnapshot(LoadedSnapshot&&) noexcept = default;
LoadedSnapshot& LoadedSnapshot::operator=(LoadedSnapshot&&) noexcept = default;

Result<LoadedSnapshot> LoadedSnapshot::create(std::span<const std::byte> snapshot,
                                              scene::Assets assets, const RestoreOptions& options) {
  try {
    if (Status status = scene::check_header(snapshot); !status) return status;
    scene::SnapshotReader reader(snapshot);
    std::array<std::uint64_t, scene::kHeaderBytes / 8> header{};
    std::uint32_t slots = 0;
    auto data = std::make_unique<Data>();
    auto& [made, free_slots, now, frame, is_taken] = *data;
    reader(header, now, frame, free_slots, slots);
    if (!reader.has_failed() &&
        (!(now >= 0 && now <= scene::kMostSeconds) || slots > reader.remaining()))
      reader.fail("the time or the number of instances cannot be");
    if (reader.has_failed()) return scene::broken(reader);
    scene::RestoreBudget budget(options);
    if (Status status = budget.check_places(slots); !status) return status;
    const scene::AssetTable table(assets);
    made.resize(slots);
    for (std::size_t i = 0; i < made.size(); ++i)
      if (Status status = scene::read_slot(reader, table, now, budget, made[i]); !status)
        return scene::in_slot(i, status);
    if (reader.remaining() > 0) reader.fail("there are more bytes than instances");
    if (reader.has_failed()) return scene::broken(reader);
    if (Status status = scene::check_slots(made, free_slots); !status) return status;
    return LoadedSnapshot(std::move(data));
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

Status Scene::restore(std::span<const std::byte> snapshot, scene::Assets assets,
                      const RestoreOptions& options) {
  const MemoryScope scope(state_->options.memory);
  Result<LoadedSnapshot> loaded = LoadedSnapshot::create(snapshot, assets, options);
  return loaded ? restore(*loaded) : loaded.error();
}

Status Scene::restore(LoadedSnapshot& loaded) {
  const MemoryScope scope(state_->options.memory);
  LoadedSnapshot::Data* const data = loaded.data_.get();
  if (data == nullptr || data->is_taken)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "a scene has taken this snapshot already; load it again");
  try {
    std::vector<Index> all;
    all.reserve(2 * data->slots.capacity() + 16);
    data->free_slots.reserve(2 * data->slots.capacity() + 16);
    state_->active = std::move(all);
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
  data->is_taken = true;
  state_->slots.swap(data->slots);
  state_->free_slots.swap(data->free_slots);
  state_->start_anew(data->now, data->frame);
  return {};
}

/// Goes on with other slots.
void Scene::State::start_anew(double time, std::uint64_t frame) noexcept {
  hidden = 0;
  results.clear();
  abandoned.clear();
  drawn.clear();
  const auto instances =
      std::ranges::count_if(slots, [](const scene::Slot& slot) { return slot.actor != nullptr; });
  stats = {.frame = frame, .instances = static_cast<Index>(instances)};
  now = time;
  for (Index slot = 0; slot < slots.size(); ++slot)
    if (slots[slot].actor) wake(slot);
}

}  // namespace sunder
