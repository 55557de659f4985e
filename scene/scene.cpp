#include <sunder/core/memory_scope.h>
#include <sunder/scene/scene.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <new>
#include <set>
#include <system_error>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "core/internal/threads.h"
#include "scene/scene_state.h"

namespace sunder {

/// Hands each command to its instance. Commands without an instance fail at once.
void Scene::State::take_commands() {
  taken.clear();
  queue.take(taken);
  for (scene::QueuedCommand& queued : taken) {
    if (scene::Actor* const actor = find(queued.instance)) {
      const Index slot = queued.instance.slot;
      actor->commands.push(std::move(queued));
      wake(slot);
      continue;
    }
    CommandResult& result = results.emplace_back();
    result.command = queued.id;
    result.instance = queued.instance;
    result.status = scene::no_instance(queued.instance);
  }
}

bool Scene::State::is_turn_of(Index slot) const {
  const double height = slots[slot].actor->screen_height;
  std::uint64_t interval = 1;
  for (const double limit : options.slower_below)
    if (height < limit) interval *= 2;
  return (stats.frame + slot) % interval == 0;  // instances take turns
}

/// Divides the budget among the instances that have optional work, before any of them runs, so that
/// results do not depend on threads.
void Scene::State::share_budget() {
  constexpr Index kMostPoints = 500;  // per instance
  std::sort(active.begin(), active.end());
  FrameBudget left = budget;
  for (std::size_t i = 0; i < active.size(); ++i) {
    scene::Actor& actor = *slots[active[(stats.frame + i) % active.size()]].actor;
    actor.allowance = {};
    if (actor.may_want_settling()) {
      actor.allowance.settled_points = std::min(kMostPoints, left.settled_points);
      left.settled_points -= actor.allowance.settled_points;
    }
    actor.allowance.has_model_work = left.model_work > 0;
    if (budget.model_work != FrameBudget::kUnlimited && left.model_work > 0)
      left.model_work -= actor.wants_model_work();
  }
}

void Scene::State::run_actors() {
  // Few instances share the threads for their vertices; many are a task each.
  const bool is_each_a_task = active.size() >= parallel_for.threads;
  struct Work {
    State* scene;
    ParallelFor inner;
  };
  const Work work = {this, is_each_a_task ? ParallelFor() : parallel_for};
  const auto task = [](const void* of, std::uint32_t index) {
    const auto& [scene, inner] = *static_cast<const Work*>(of);
    const MemoryScope scope(scene->options.memory);
    const Index slot = scene->active[index];
    scene->slots[slot].actor->update({scene->now, scene->is_turn_of(slot), inner, scene->background,
                                      scene->slots[slot].actor->allowance});
  };
  const auto count = static_cast<std::uint32_t>(active.size());
  if (is_each_a_task && parallel_for.run != nullptr && count > 1)
    parallel_for.run(parallel_for.context, count, task, &work);
  else
    for (std::uint32_t i = 0; i < count; ++i) task(&work, i);
}

/// Sums up what the instances did, and lists those that stay active.
void Scene::State::collect() {
  std::sort(active.begin(), active.end());
  std::size_t kept = 0;
  for (const Index slot : active) {
    scene::Actor& actor = *slots[slot].actor;
    const scene::ActorFrame& of = actor.frame;
    stats.sampled += of.was_sampled;
    stats.advanced += of.was_advanced;
    stats.drawn += of.was_drawn;
    stats.waiting += of.was_waiting;
    stats.unchanged += !of.was_waiting && !of.was_idle && !of.was_advanced && !of.was_drawn;
    stats.vertices += of.vertices;
    stats.animation += of.animation;
    stats.operations += of.operations;
    stats.settling += of.settling;
    stats.settled_points += of.settled_points;
    stats.model_work += of.did_model_work;
    stats.unsettled += actor.wants_settling();
    stats.tissue += of.tissue;
    stats.drawing += of.drawing;
    if (of.was_drawn) drawn.push_back({slot, slots[slot].generation});
    std::vector<CommandResult>& of_actor = actor.commands.results();
    std::move(of_actor.begin(), of_actor.end(), std::back_inserter(results));
    of_actor.clear();
    stats.in_background += actor.commands.background_count();
    actor.is_listed = actor.is_active() || actor.may_pack();
    if (actor.is_listed)
      active[kept++] = slot;
    else
      actor.fall_idle();
    actor.is_hidden = !actor.is_listed && actor.is_busy();
    hidden += actor.is_hidden;
  }
  active.resize(kept);
  std::sort(results.begin(), results.end(),
            [](const CommandResult& a, const CommandResult& b) { return a.command < b.command; });
  if (stats.settled_points > 0)
    settling_rate += 0.1 * (stats.settling / stats.settled_points - settling_rate);
  stats.commands = static_cast<std::uint32_t>(results.size());
  for (const CommandResult& result : results) stats.failed += !result.status;
}

Scene::Scene(std::unique_ptr<State> state) : state_(std::move(state)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

Result<Scene> Scene::create(const SceneOptions& options) {
  for (const double height : options.slower_below)
    if (!(std::isfinite(height) && height >= 0))
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "slower_below is %g pixels; it must be finite and not negative",
                             height);
  const MemoryScope scope(options.memory);
  try {
    auto state = std::make_unique<State>(options);
    state->parallel_for = options.parallel_for;
    const std::uint32_t cores = std::max(1u, Thread::hardware_concurrency());
    if (options.parallel_for.run == nullptr && options.threads != 1) {
      state->pool =
          std::make_unique<scene::ThreadPool>(options.threads == 0 ? cores : options.threads);
      state->parallel_for = state->pool->parallel_for();
    }
    return Scene(std::move(state));
  } catch (const std::system_error& error) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "cannot start a thread: %s",
                           error.what());
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

// ---- Instances.

Result<InstanceId> Scene::spawn(std::shared_ptr<const CharacterAsset> asset,
                                const SpawnOptions& options) {
  const MemoryScope scope(state_->options.memory);
  Result<CharacterInstance> made = CharacterInstance::create(std::move(asset), options.capacity);
  if (!made) return made.error();
  State& state = *state_;
  try {
    auto actor = std::make_unique<scene::Actor>(std::move(*made), options.is_visible, state.now);
    if (state.free_slots.empty()) {
      if (state.slots.size() == state.slots.capacity())
        state.slots.reserve(2 * state.slots.size() + 16);
      state.active.reserve(2 * state.slots.capacity());
      state.free_slots.reserve(2 * state.slots.capacity());
      state.free_slots.push_back(static_cast<Index>(state.slots.size()));
      state.slots.emplace_back();
    }
    const Index slot = state.free_slots.back();
    state.free_slots.pop_back();
    state.slots[slot].actor = std::move(actor);
    ++state.stats.instances;
    state.wake(slot);
    return InstanceId{slot, state.slots[slot].generation};
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Status Scene::destroy(InstanceId id) {
  const MemoryScope scope(state_->options.memory);
  State& state = *state_;
  scene::Actor* const actor = state.find(id);
  if (actor == nullptr) return scene::no_instance(id);
  try {
    actor->commands.abandon(scene::no_instance(id));
    std::vector<CommandResult>& abandoned = actor->commands.results();
    std::move(abandoned.begin(), abandoned.end(), std::back_inserter(state.abandoned));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
  if (actor->is_listed) std::erase(state.active, id.slot);
  state.hidden -= actor->is_hidden;
  state.slots[id.slot].actor.reset();
  ++state.slots[id.slot].generation;
  state.free_slots.push_back(id.slot);
  --state.stats.instances;
  return {};
}

bool Scene::contains(InstanceId id) const { return state_->find(id) != nullptr; }
std::uint32_t Scene::instance_count() const { return state_->stats.instances; }

CharacterInstance* Scene::find(InstanceId id) {
  scene::Actor* const actor = state_->find(id);
  if (actor == nullptr) return nullptr;
  state_->wake(id.slot);
  actor->touch();
  return &actor->instance;
}

const CharacterInstance* Scene::find(InstanceId id) const {
  const scene::Actor* const actor = state_->find(id);
  return actor == nullptr ? nullptr : &actor->instance;
}

// ---- Motion and visibility.

Result<LayerId> Scene::play(InstanceId id, std::uint32_t clip, const LayerOptions& options) {
  const MemoryScope scope(state_->options.memory);
  ClipPlayer* const of = player(id);
  if (of == nullptr) return contains(id) ? out_of_memory() : scene::no_instance(id);
  const std::shared_ptr<const Character>& character = find(id)->asset()->character();
  if (clip >= character->clips.size())
    return Status::failure(StatusCode::index_out_of_range, clip,
                           "there is no clip %u; the character has %zu", clip,
                           character->clips.size());
  return of->play(clip_of(character, clip), options);
}

ClipPlayer* Scene::player(InstanceId id) {
  const MemoryScope scope(state_->options.memory);
  scene::Actor* const actor = state_->find(id);
  if (actor == nullptr) return nullptr;
  try {
    ClipPlayer& of = actor->player(state_->now);
    state_->wake(id.slot);
    return &of;
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

Status Scene::stop(InstanceId id) {
  const MemoryScope scope(state_->options.memory);
  return state_->call(id, [](scene::Actor& actor) -> Status {
    actor.stop();
    return {};
  });
}

Status Scene::set_pose(InstanceId id, const ModelPose& pose) {
  const MemoryScope scope(state_->options.memory);
  return state_->call(id, [&](scene::Actor& actor) { return actor.set_pose(pose); });
}

Status Scene::set_pose(InstanceId id, const Pose& pose) {
  const MemoryScope scope(state_->options.memory);
  return state_->call(id, [&](scene::Actor& actor) {
    ModelPose model;
    const Status status =
        compute_model_pose(actor.instance.asset()->character()->skeleton, pose, model);
    return status ? actor.set_pose(model) : status;
  });
}

Status Scene::set_visible(InstanceId id, bool is_visible) {
  return state_->call(id, [&](scene::Actor& actor) -> Status {
    actor.set_visible(is_visible);
    return {};
  });
}

Status Scene::set_screen_height(InstanceId id, double pixels) {
  if (!(pixels > 0))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the height on the screen is %g pixels; it must be above 0", pixels);
  return state_->call(id, [&](scene::Actor& actor) -> Status {
    actor.screen_height = pixels;
    return {};
  });
}

// ---- Frames.

Result<CommandId> Scene::submit(InstanceId id, SceneCommand command,
                                const CommandOptions& options) {
  const MemoryScope scope(state_->options.memory);
  try {
    return state_->queue.push(id, std::move(command), options);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Status Scene::update(double seconds) {
  const MemoryScope scope(state_->options.memory);
  if (!std::isfinite(seconds))
    return Status::failure(StatusCode::non_finite_value, kNone,
                           "the time since the last update is not finite");
  if (seconds < 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the time since the last update is %g s; it must not be negative",
                           seconds);
  State& state = *state_;
  const auto begin = std::chrono::steady_clock::now();
  const std::uint64_t frame = state.stats.frame + 1;
  state.stats = {.frame = frame, .instances = state.stats.instances};
  state.now += seconds;
  Status status;
  try {
    state.results.swap(state.abandoned);
    state.abandoned.clear();
    state.drawn.clear();
    state.drawn.reserve(state.slots.size());
    state.take_commands();
    state.stats.idle =
        state.stats.instances - static_cast<Index>(state.active.size()) - state.hidden;
    state.stats.unseen = state.hidden;
    state.share_budget();
    state.run_actors();
    for (const Index slot : state.active)
      if (const Status& of = state.slots[slot].actor->frame.status; !of && status) {
        status = Status::failure(of.code(), slot, "instance %u: %s", slot, of.text().data());
      }
    state.collect();
  } catch (const std::bad_alloc&) {
    status = out_of_memory();
  }
  state.stats.total =
      std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
  return status;
}

void Scene::set_budget(const FrameBudget& budget) { state_->budget = budget; }

FrameBudget Scene::budget_of(double microseconds) const {
  const double points = std::clamp(microseconds / state_->settling_rate, 0.0, 1e9);
  return {static_cast<std::uint32_t>(points), microseconds > 0 ? 1u : 0u};
}

const FrameStats& Scene::stats() const { return state_->stats; }
std::span<const CommandResult> Scene::results() const { return state_->results; }
std::span<const InstanceId> Scene::drawn() const { return state_->drawn; }

PosedMesh Scene::mesh(InstanceId id, std::uint32_t mesh, std::uint64_t seen) {
  const MemoryScope scope(state_->options.memory);
  scene::Actor* const actor = state_->find(id);
  return actor == nullptr ? PosedMesh() : actor->shown().mesh(mesh, seen);
}

std::uint32_t Scene::shown_level(InstanceId id) const {
  const scene::Actor* const actor = state_->find(id);
  return actor == nullptr ? 0 : actor->shown_level();
}

Scene::Memory Scene::memory_bytes() const {
  Memory memory;
  memory.instances =
      sizeof(State) + state_->slots.capacity() * (sizeof(scene::Slot) + 2 * sizeof(Index));
  std::set<const CharacterAsset*> assets;
  const auto add = [&](const CharacterAsset* asset) {
    for (; asset != nullptr; asset = asset->options().coarser.get())
      if (assets.insert(asset).second) memory.assets += asset->memory_bytes();
  };
  for (const scene::Slot& slot : state_->slots) {
    if (!slot.actor) continue;
    memory.instances += slot.actor->memory_bytes();
    add(slot.actor->instance.asset().get());
  }
  return memory;
}

}  // namespace sunder
