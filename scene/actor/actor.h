#pragma once

#include <sunder/scene/scene.h>

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "scene/actor/actor_commands.h"
#include "scene/actor/detail_levels.h"
#include "scene/actor/playback.h"
#include "scene/snapshot/pose_memory.h"

namespace sunder::scene {

/// The part of an update that one instance took.
struct ActorFrame {
  Status status;
  bool was_sampled = false, was_advanced = false, was_drawn = false;
  bool was_waiting = false, was_idle = false, was_switched = false;
  bool did_model_work = false;
  Index vertices = 0, settled_points = 0;
  double animation = 0, operations = 0, settling = 0, tissue = 0, drawing = 0;  ///< Microseconds.
};

/// An instance in a scene: its character, what moves it, and what it still has to do.
class Actor {
 public:
  /// @param now  time of the scene, seconds.
  Actor(CharacterInstance made, bool is_visible, double now)
      : instance(std::move(made)),
        is_visible_(is_visible),
        now_(now),
        last_operation_(now - kCalm) {}

  /// The share of a budget; see FrameBudget.
  struct Allowance {
    Index settled_points = 0;
    bool has_model_work = false;
  };
  /// The inputs of a frame.
  struct Frame {
    double now;                ///< Time of the scene, seconds.
    bool is_its_turn = true;   ///< Otherwise it is updated only while it is being torn.
    ParallelFor parallel_for;  ///< For the vertices of this instance alone.
    Background& background;
    const Allowance& allowance;
  };
  /// Runs as a task: touches nothing but this object.
  void update(const Frame& frame);

  /// The player. @throws std::bad_alloc
  [[nodiscard]] ClipPlayer& player(double now) {
    return playback_.player(instance.asset()->character(), now);
  }
  void stop() { playback_.stop(); }
  Status set_pose(const ModelPose& pose);
  void set_visible(bool is_visible) { is_visible_ = is_visible; }
  /// Whether it would have something to do in the next update if it were visible.
  [[nodiscard]] bool is_busy() const;
  /// Whether it has to be looked at in the next update.
  [[nodiscard]] bool is_active() const {
    return commands.has_waiting() || commands.background_count() > 0 || (is_visible_ && is_busy());
  }
  /// Whether it is being torn: then it is updated at the full rate.
  [[nodiscard]] bool is_being_torn() const {
    return instance.is_in_stroke() || commands.has_waiting() || now_ < last_operation_ + kCalm;
  }

  /// Whether there is optional work.
  [[nodiscard]] bool wants_settling() const { return is_visible_ && shown().needs_settling(); }
  /// The same after the commands of an update.
  [[nodiscard]] bool may_want_settling() const {
    return wants_settling() || commands.has_waiting() || commands.background_count() > 0;
  }
  [[nodiscard]] bool wants_model_work() const {
    return commands.has_refits() || levels_.is_changing() || may_pack();
  }

  /// Whether the workspace of a model that nobody tears any more can be given back.
  [[nodiscard]] bool may_pack() const;

  /// Somebody may make calls on the instance.
  void touch() { is_packed_ = false; }
  /// Frees what only an active instance needs.
  void fall_idle() noexcept;
  /// The part of an actor that a snapshot keeps, in addition to its instance.
  struct State {
    bool is_visible = true, has_new_pose = true;
    double screen_height = 0, now = 0, last_operation = 0;
    std::optional<ClipPlayerState> player;
    double player_now = 0;  ///< Time of the scene up to which the player advanced.
    bool needs_sample = false;
    ModelPose pose, next_pose;  ///< Of the instance, and of its next advance(); empty: none.
  };
  /// @throws std::bad_alloc
  [[nodiscard]] State state() const;
  /// @param now  time of the scene.
  /// @return the fault of a state that does not fit the instance. @throws std::bad_alloc
  Status restore(const State& state, double now);
  /// Moments of clips in whose poses commands were applied.
  [[nodiscard]] std::span<const PoseOrigin> origins() const { return origins_; }
  void set_origins(std::vector<PoseOrigin> origins) { origins_ = std::move(origins); }

  [[nodiscard]] std::size_t memory_bytes() const {
    return sizeof(*this) + instance.memory_bytes() + levels_.memory_bytes() +
           pose_.model_from_bone.capacity() * sizeof(Affine3d);
  }

  /// The level of detail that is shown.
  [[nodiscard]] Index shown_level() const { return levels_.shown(); }
  [[nodiscard]] CharacterInstance& shown() {
    return levels_.shown() == 0 ? instance : levels_.at(levels_.shown());
  }
  [[nodiscard]] const CharacterInstance& shown() const {
    return levels_.shown() == 0 ? instance : levels_.at(levels_.shown());
  }

  CharacterInstance instance;  ///< The finest level, which operations tear.
  double screen_height = std::numeric_limits<double>::infinity();
  ActorCommands commands;
  Allowance allowance;     ///< Of the update in progress.
  ActorFrame frame;        ///< The last update.
  bool is_listed = false;  ///< Whether it is in the list of active instances.
  bool is_hidden = false;  ///< Whether it would be, if it were visible.

 private:
  /// After an operation, the wound moves; for so many seconds it is seen at the full rate.
  static constexpr double kCalm = 1.0;

  /// The pose of this frame.
  [[nodiscard]] const ModelPose& pose() const {
    return pose_.model_from_bone.empty() ? shown().pose() : pose_;
  }
  Status animate();
  Status move(double seconds, const Frame& frame);
  void work_on_commands(const Frame& frame);
  void note_origin();
  void pack();
  void settle(Index points);
  void show_level(Background& background, bool may_change);
  void draw(const ParallelFor& parallel_for);

  Playback playback_;
  std::vector<PoseOrigin> origins_;
  DetailLevels levels_;
  ModelPose pose_;  ///< Empty: that of the level that is shown.
  bool has_new_pose_ = true;
  bool is_visible_;
  bool is_packed_ = false;  ///< Whether the model was packed since the last command.
  double now_;              ///< Time of the scene at the last update that was not left out.
  double last_operation_;   ///< Time of the scene.
};

}  // namespace sunder::scene
