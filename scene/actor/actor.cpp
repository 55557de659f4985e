#include "scene/actor/actor.h"

#include <sunder/skinning/pose.h>

#include <chrono>
#include <cmath>
#include <new>
#include <system_error>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "scene/snapshot/check_pose.h"

namespace sunder::scene {
namespace {

/// Adds the time until the end of a block to a sum of microseconds.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), begin_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() {
    sum_ += std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin_)
                .count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& sum_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace

Status Actor::set_pose(const ModelPose& pose) {
  if (Status status = check_pose(instance.character(), pose); !status) return status;
  try {
    ModelPose copy = pose;
    std::swap(pose_, copy);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
  has_new_pose_ = true;
  playback_.stop();
  return {};
}

/// Gives back the workspace of a model that nobody tears any more. Soft tissue that is awake reads
/// it in each step. It is optional: if it fails, the model stays as it is.
void Actor::pack() {
  if (!may_pack()) return;
  frame.did_model_work = true;
  is_packed_ = static_cast<bool>(instance.pack());
}

bool Actor::may_pack() const {
  if (is_packed_ || instance.model() == nullptr || is_being_torn() || instance.needs_step())
    return false;
  return instance.body() == nullptr || !is_busy();
}

void Actor::fall_idle() noexcept {
  if (!has_new_pose_) pose_ = {};
  commands.clear();
}

bool Actor::is_busy() const {
  return playback_.is_playing() || has_new_pose_ || shown().needs_step() || shown().needs_draw() ||
         levels_.is_changing() || is_being_torn();
}

Status Actor::animate() {
  const Character& character = *instance.asset()->character();
  playback_.advance(now_);
  if (!playback_.needs_sample()) {
    if (!pose().model_from_bone.empty()) return {};
    Result<ModelPose> rest = rest_pose(character);
    if (!rest) return rest.error();
    pose_ = std::move(*rest);
    return {};
  }
  frame.was_sampled = true;
  has_new_pose_ = true;
  if (Status status = playback_.sample(character, pose_); !status) return status;
  return check_pose(character, pose_);  // clips, and differences of them, may leave any range
}

void Actor::work_on_commands(const Frame& of) {
  if (!commands.has_waiting() && commands.background_count() == 0) return;
  const Stopwatch watch(frame.operations);
  const std::size_t before = commands.results().size();
  frame.did_model_work =
      commands.finish_background(instance, of.background, of.allowance.has_model_work);
  commands.apply(pose(), instance, of.background);
  if (commands.results().size() == before) return;
  last_operation_ = now_;
  is_packed_ = false;
  note_origin();
}

/// A snapshot then keeps the moment of the clip instead of all matrices.
void Actor::note_origin() {
  if (!playback_.is_playing() || playback_.needs_sample()) return;
  const std::uint64_t hash = hash_of(pose());
  if (!origins_.empty() && origins_.back().hash == hash) return;
  const Result<ClipPlayerState> state = playback_.known_player()->state();
  if (!state || state->layers.size() != 1) return;
  const std::vector<Clip>& clips = instance.asset()->character()->clips;
  const ClipPlayerState::Layer& layer = state->layers[0];
  const Result<LayerState> at =
      playback_.known_player()->layer({layer.slot, state->generations[layer.slot]});
  for (Index clip = 0; at && clip < clips.size(); ++clip)
    if (&clips[clip] == layer.clip.get()) origins_.push_back({hash, clip, at->time});
}

Actor::State Actor::state() const {
  State state;
  state.is_visible = is_visible_;
  state.has_new_pose = has_new_pose_;
  state.screen_height = screen_height;
  state.now = now_;
  state.last_operation = last_operation_;
  state.pose = shown().pose();
  state.next_pose = pose_;
  if (!playback_.known_player()) return state;
  Result<ClipPlayerState> player = playback_.known_player()->state();
  if (!player) throw std::bad_alloc();
  state.player = std::move(*player);
  state.player_now = playback_.now();
  state.needs_sample = playback_.needs_sample();
  return state;
}

Status Actor::restore(const State& state, double now) {
  const Character& character = *instance.asset()->character();
  const auto has_been = [&](double time) { return time >= 0 && time <= now; };
  if (!(state.screen_height > 0) || !has_been(state.now) || !has_been(state.player_now) ||
      !(state.last_operation >= -kCalm && state.last_operation <= now))
    return Status::failure(StatusCode::malformed_file, kNone,
                           "the height of an instance is not above 0, or a time of it is not one "
                           "of the scene");
  for (const ModelPose* pose : {&state.pose, &state.next_pose})
    if (!pose->model_from_bone.empty())
      if (Status status = check_pose(character, *pose); !status) return status;
  if (!state.pose.model_from_bone.empty())
    if (Status status = instance.advance(state.pose, 0); !status) return status;
  pose_ = state.next_pose;
  is_visible_ = state.is_visible;
  has_new_pose_ = state.has_new_pose;
  screen_height = state.screen_height;
  now_ = state.now;
  last_operation_ = state.last_operation;
  if (!state.player) return {};
  if (Status status = player(state.player_now).restore(*state.player); !status) return status;
  if (!state.needs_sample) playback_.note_sampled();
  return {};
}

/// Chooses the level of detail, and lets it follow the pose of this frame.
void Actor::show_level(Background& background, bool may_change) {
  const Index wanted = is_being_torn() ? 0 : DetailLevels::wanted(*instance.asset(), screen_height);
  if (wanted != 0 && wanted != levels_.shown() && !may_change) return levels_.postpone();
  const Index shown = levels_.prepare(wanted, instance, background);
  frame.was_switched = shown != levels_.shown();
  if (!frame.was_switched) return;
  if (pose_.model_from_bone.empty()) pose_ = this->shown().pose();
  levels_.show(shown);
  frame.did_model_work = true;
}

void Actor::settle(Index points) {
  if (points == 0 || !wants_settling()) return;
  const Stopwatch watch(frame.settling);
  frame.settled_points = points;
  (void)shown().settle(points);
}

void Actor::update(const Frame& of) {
  frame = {};
  frame.was_waiting = !of.is_its_turn && !is_being_torn();
  frame.was_idle = !is_active();
  if (frame.was_idle && of.allowance.has_model_work) pack();
  if (frame.was_waiting || frame.was_idle) return;
  if (instance.body() != nullptr) is_packed_ = false;  // what moves is unpacked
  const double seconds = of.now - now_;
  now_ = of.now;
  try {
    frame.status = move(seconds, of);
    if (frame.status && is_visible_ && (shown().needs_draw() || frame.was_switched))
      draw(of.parallel_for);
    if (of.allowance.has_model_work) pack();
  } catch (const std::system_error& error) {
    frame.status = Status::failure(StatusCode::limit_exceeded, kNone, "cannot start a thread: %s",
                                   error.what());
  } catch (const std::bad_alloc&) {
    frame.status = out_of_memory();
  }
}

Status Actor::move(double seconds, const Frame& of) {
  {
    const Stopwatch watch(frame.animation);
    if (Status status = animate(); !status) return status;
  }
  work_on_commands(of);
  show_level(of.background, of.allowance.has_model_work);
  if (!has_new_pose_ && !frame.was_switched && !shown().needs_step()) return {};
  settle(of.allowance.settled_points);
  const Stopwatch watch(frame.tissue);
  Status status = shown().advance(pose(), frame.was_switched ? 0 : seconds, 0);
  frame.was_advanced = static_cast<bool>(status);
  if (status) has_new_pose_ = false;
  return status;
}

void Actor::draw(const ParallelFor& parallel_for) {
  const Stopwatch watch(frame.drawing);
  frame.status = shown().draw(parallel_for);
  frame.was_drawn = static_cast<bool>(frame.status);
  if (frame.was_drawn) frame.vertices = shown().drawn_vertices();
}

}  // namespace sunder::scene
