#pragma once

#include <memory>

#include "particles/clusters/fork_link.h"
#include "particles/clusters/structure.h"

namespace sunder::particles {

/// The data of a ParticleSet: a decomposition that other sets share, or after the first tear one of
/// its own.
struct SetData {
  std::shared_ptr<const Structure> shared;  ///< Null if the set was made alone.
  std::unique_ptr<Structure> own;
  SurfacePose pose;              ///< Memory of ParticleSet::rest(): the pose of its last call.
  bool has_pose = false;         ///< Whether `pose` has memory.
  bool is_broken = false;        ///< Memory ran out before there was a structure of its own.
  std::weak_ptr<ForkLink> fork;  ///< While there is one, the structure does not change.

  SetData() = default;
  ~SetData() { end_fork(); }
  SetData(const SetData&) = delete;
  SetData& operator=(const SetData&) = delete;

  /// Lets the structure change again. Waits while it is copied.
  void end_fork() noexcept {
    if (const std::shared_ptr<ForkLink> link = fork.lock()) {
      const std::lock_guard lock(link->mutex);
      link->from = nullptr;
    }
    fork.reset();
  }
  [[nodiscard]] const Structure& now() const { return own ? *own : *shared; }
  /// The structure to be changed. The first call copies the shared one. @throws std::bad_alloc
  [[nodiscard]] Structure& to_change() {
    if (!own) own = shared->copy();
    return *own;
  }
  [[nodiscard]] std::size_t memory_bytes() const;
};

}  // namespace sunder::particles
