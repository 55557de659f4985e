#pragma once

#include <atomic>
#include <memory>

#include "particles/clusters/fork_link.h"
#include "particles/clusters/packed_points.h"
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
  /// @throws std::bad_alloc if it was packed.
  [[nodiscard]] const Structure& now() const {
    unpack();
    return without_points();
  }
  /// Null without memory to unpack it.
  [[nodiscard]] const Structure* find() const noexcept;
  [[nodiscard]] Index point_count() const;
  /// Without the columns of its points, which may be packed.
  [[nodiscard]] const Structure& without_points() const { return own ? *own : *shared; }
  /// The structure to be changed. The first call copies the shared one. @throws std::bad_alloc
  [[nodiscard]] Structure& to_change() {
    if (!own) own = shared->copy();
    unpack();
    return *own;
  }
  /// Packs the columns of points, unless there is work to do, or it would not save anything.
  /// @throws std::bad_alloc, and nothing changes.
  void pack();
  [[nodiscard]] bool is_packed() const { return packed_now_.load(std::memory_order_acquire); }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  /// Reentrant.
  void unpack() const {
    if (is_packed()) unpack_points();
  }
  void unpack_points() const;

  mutable Mutex unpacking_;
  mutable std::unique_ptr<const PackedPoints> packed_;  ///< Of `own`.
  mutable std::atomic<bool> packed_now_ = false;        ///< Whether there is `packed_`.
};

}  // namespace sunder::particles
