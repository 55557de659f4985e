#pragma once

#include <sunder/tear/torn_model.h>

#include <atomic>
#include <memory>

#include "core/internal/threads.h"
#include "tear/model/asset_parts.h"

namespace sunder {

/// All that a model has while it has no workspace, and the workspace while it has one.
struct TornModel::Instance {
  Instance(std::shared_ptr<const TornAsset> of, const TornCapacity& size)
      : asset(std::move(of)), capacity(size) {}
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  [[nodiscard]] TornAsset::Parts& parts() const { return *asset->parts_; }
  /// Null while the model has no workspace.
  [[nodiscard]] State* resident() const { return workspace_.load(std::memory_order_acquire); }
  /// The state in a workspace, which is taken if necessary. @throws std::bad_alloc
  State& unpacked();
  /// Gives the workspace back. @throws std::bad_alloc: nothing changes
  void pack();
  /// The same; null, and no workspace is taken, if there are no operations.
  State* torn();
  /// Calls read(state, packed operations), of which one is null at least.
  template <class Read>
  auto read(Read read) const {
    const State* const known = resident();
    if (known != nullptr) return read(known, nullptr);
    const std::lock_guard lock(unpacking_);
    return read(resident(), packed_.get());
  }
  /// Calls read(history), null if there is none.
  template <class Read>
  auto read_history(Read read_it) const {
    return read([&](const State* state, const tear::PackedOperations* packed) {
      return read_it(state != nullptr ? &state->history
                                      : (packed != nullptr ? &packed->history : nullptr));
    });
  }

  const std::shared_ptr<const TornAsset> asset;
  const TornCapacity capacity;
  WeightOptions weights;  ///< While the model has no workspace.

 private:
  State& take_workspace();

  mutable Mutex unpacking_;  ///< Const calls on several threads may unpack.
  /// Null if there are none, and while the model has a workspace.
  std::unique_ptr<tear::PackedOperations> packed_;
  std::atomic<State*> workspace_ = nullptr;  ///< Owned.
};

}  // namespace sunder
