#pragma once

#include <sunder/scene/scene.h>

#include <memory>
#include <utility>
#include <vector>

#include "scene/actor/actor.h"
#include "scene/threads/thread_pool.h"

namespace sunder {
namespace scene {

struct Slot {
  std::uint32_t generation = 0;
  std::unique_ptr<scene::Actor> actor;  ///< Null: free.
};

[[nodiscard]] inline Status no_instance(InstanceId id) {
  return Status::failure(StatusCode::not_found, id.slot, "there is no instance %u of generation %u",
                         id.slot, id.generation);
}

}  // namespace scene

struct Scene::State {
  SceneOptions options;
  std::unique_ptr<scene::ThreadPool> pool;
  ParallelFor parallel_for;
  std::vector<scene::Slot> slots;
  std::vector<Index> free_slots;
  std::vector<Index> active;  ///< Slots that the next update looks at.
  Index hidden = 0;           ///< Instances that are busy but not visible.
  scene::CommandQueue queue;
  std::vector<scene::QueuedCommand> taken;
  std::vector<CommandResult> results;
  std::vector<CommandResult>
      abandoned;  ///< Of instances that were destroyed since the last update.
  std::vector<InstanceId> drawn;
  FrameStats stats;
  FrameBudget budget;
  double settling_rate = 1.0;  ///< Measured microseconds per point.
  double now = 0;
  scene::Background background;  // ends before anything that its jobs use

  explicit State(const SceneOptions& of)
      : options(of), background(of.background, of.background_updates) {}

  [[nodiscard]] scene::Actor* find(InstanceId id) const {
    if (id.slot >= slots.size() || slots[id.slot].generation != id.generation) return nullptr;
    return slots[id.slot].actor.get();
  }
  /// Lets the next update look at an instance. There is room in the list for all slots.
  void wake(Index slot) noexcept {
    scene::Actor& actor = *slots[slot].actor;
    hidden -= std::exchange(actor.is_hidden, false);
    if (std::exchange(actor.is_listed, true)) return;
    active.push_back(slot);
  }
  template <class Call>
  Status call(InstanceId id, Call make_call) {
    scene::Actor* const actor = find(id);
    if (actor == nullptr) return scene::no_instance(id);
    Status status = make_call(*actor);
    if (status) wake(id.slot);
    return status;
  }

  void start_anew(double time, std::uint64_t frame) noexcept;
  void take_commands();
  void share_budget();
  void run_actors();
  void collect();
  [[nodiscard]] bool is_turn_of(Index slot) const;
};

}  // namespace sunder
