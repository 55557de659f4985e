#pragma once

#include <sunder/particles/particle_fork.h>
#include <sunder/tear/operation_job.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scene/drawing/instance_mesh.h"

namespace sunder::scene {

/// Prepares on another thread what an instance needs when an operation takes effect, so that the
/// frame in which it is swapped in only exchanges it.
class PreparedSwap {
 public:
  /// @param meshes  of the asset.
  /// @param fork    of the particles, if there are any.
  PreparedSwap(std::shared_ptr<const CharacterAsset> asset, std::span<const AssetMesh> meshes,
               std::optional<ParticleFork> fork)
      : asset_(std::move(asset)), meshes_(meshes), fork_(std::move(fork)) {}

  /// Runs as OperationJob::Observer. Without memory nothing is prepared. @throws nothing
  void prepare(const TornModel& replica, std::span<const ChangeRecord> changes) noexcept;

  // ---- In the frame of the swap.

  /// Lets particles follow the operation. @return false if they were not prepared.
  [[nodiscard]] bool give(ParticleSet& particles, const TornModel& model);
  /// Nothing will be given: particles settle again.
  void cancel() noexcept { fork_.reset(); }
  /// Gives meshes what they would make of the changes that they have noted.
  void give(std::span<InstanceMesh> meshes) noexcept;

 private:
  void prepare_tails(const TornModel& replica, std::span<const ChangeRecord> changes);

  std::shared_ptr<const CharacterAsset> asset_;
  std::span<const AssetMesh> meshes_;  ///< Of the asset.
  std::optional<ParticleFork> fork_;
  bool has_followed_ = false;
  struct OfMesh {
    Index mesh;
    PreparedTail tail;
  };
  std::vector<OfMesh> tails_;
};

/// An operation that runs in the background, and what it prepares.
struct BegunOperation {
  OperationJob job;
  std::shared_ptr<PreparedSwap> prepared;
};

}  // namespace sunder::scene
