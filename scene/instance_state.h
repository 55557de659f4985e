#pragma once

#include <sunder/core/memory_scope.h>
#include <sunder/scene/character_instance.h>
#include <sunder/scene/scene_command.h>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scene/asset_data.h"
#include "scene/drawing/instance_mesh.h"
#include "scene/drawing/prepared_swap.h"
#include "scene/torn_parts.h"
#include "scene/wound_masks.h"

namespace sunder {

/// The status of every call on an instance that ran out of memory half-way.
[[nodiscard]] Status broken_for_lack_of_memory();

/// The parts of an instance that is drawn.
struct DrawnParts {
  std::vector<BonePalette> palettes;  ///< One per skin.
  std::vector<scene::InstanceMesh> meshes;
};

struct CharacterInstance::State {
  State(std::shared_ptr<const CharacterAsset> of, const TornCapacity& room);
  /// Whether an epoch is one of this object.
  [[nodiscard]] bool is_own(std::uint64_t other) const { return (other ^ epoch) >> 32 == 0; }

  std::shared_ptr<const CharacterAsset> asset;
  std::pmr::memory_resource* memory = MemoryScope::current();  ///< From which all calls allocate.
  TornCapacity capacity;
  std::unique_ptr<scene::TornParts> torn;  ///< Null before the first operation.
  std::unique_ptr<DrawnParts> drawn;       ///< Null before the first draw().
  ModelPose pose;
  /// Upper half: a number of this object; lower half: of the last draw() that had something to do.
  std::uint64_t epoch;
  std::optional<scene::BegunOperation> begun;      ///< The newest operation in the background.
  std::unique_ptr<scene::WoundMasks> wound_masks;  ///< Null before the first one begins.
  bool needs_draw = false;
  bool is_broken = false;  ///< Memory ran out between two parts, which no longer agree.

  [[nodiscard]] const scene::AssetData& shared() const { return *asset->data_; }
  [[nodiscard]] const Character& character() const {
    return torn ? torn->model.character() : *shared().character;
  }

  /// Makes what the first operation needs, if it is not there.
  Status require_torn();
  /// Makes it. @param is_soft  with a soft body, which the asset has.
  Status make_torn(bool is_soft);
  /// The same, and the model has all memory for it.
  Status prepare_model();
  /// The same for the particles.
  Status prepare_to_tear();
  /// Replaces the soft body. A failure changes nothing. @throws std::bad_alloc
  Status restore_tissue(const SoftTissue& soft, ParticleSet set, const StateArrays& body);
  /// Makes what draw() needs, if it is not there. @throws std::bad_alloc
  Status require_drawn();
  /// Lets the meshes and the wound masks know.
  void note(std::span<const ChangeRecord> changes) noexcept;
  /// The same, and the particles.
  Status follow(std::span<const ChangeRecord> changes);
  /// Keeps the motion of a piece before its particles vanish. Without memory it is at rest.
  void keep_tissue(const DetachedPiece& piece, PieceTissue& tissue) noexcept;
  /// Begins an operation on a replica, with what its swap_in() needs.
  /// @param create  makes the job with an observer.
  Result<OperationJob> begin_operation(
      const std::function<Result<OperationJob>(OperationJob::Observer)>& create);
  Result<TearReport> swap_in(const OperationJob& job, ChangeRecord* change);
  /// The same, with the motion of the piece of a detachment.
  Result<TearReport> swap_in(const OperationJob& job, ChangeRecord* change, PieceTissue* tissue);
  /// Drops what an operation prepared that failed.
  void drop(const OperationJob& job) noexcept;
  Status set_palettes();
  Status update_mesh(Index mesh);
  /// How particles displace a mesh, without gradients.
  [[nodiscard]] VertexDisplacements displacements(Index mesh);
  Status draw_mesh(Index mesh, const ParallelFor& parallel_for);
  Status draw(const ParallelFor& parallel_for);
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Returns memory that only the next operation would use.
  void release_scratch() noexcept { scratch_ = {}; }

  /// Makes one call that tears, and passes its record on to the particles and the meshes.
  template <class Call>
  auto change(ChangeRecord* wanted, Call call) -> decltype(call(wanted)) {
    if (Status status = require_torn(); !status) return status;
    ChangeRecord& record = wanted != nullptr ? *wanted : scratch_;
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
    if (Status status = require_torn(); !status) return status;
    std::vector<ChangeRecord> unwanted;
    std::vector<ChangeRecord>& records = wanted != nullptr ? *wanted : unwanted;
    const std::size_t before = records.size();
    auto outcome = call(&records);
    const auto made = std::span<const ChangeRecord>(records).subspan(before);
    if (outcome || !made.empty())
      if (Status status = pass_on(made); !status) return status;
    return outcome;
  }

 private:
  ChangeRecord scratch_;  ///< For callers that want no record.
};

}  // namespace sunder
