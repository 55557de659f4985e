#include "scene/actor.h"

#include <sunder/skinning/pose.h>

#include <chrono>
#include <cmath>
#include <new>
#include <utility>

#include "scene/check_pose.h"

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

/// Makes the calls of commands on an instance in a pose.
class CommandCalls {
 public:
  CommandCalls(CharacterInstance& instance, const ModelPose& pose,
               std::vector<ChangeRecord>* changes)
      : instance_(instance), pose_(pose), changes_(changes) {}

  Result<TearReport> operator()(const TearCommand& of) {
    return instance_.tear(pose_, of.stroke, of.options, record());
  }
  Result<TearReport> operator()(const PlaneCut& of) { return instance_.cut(pose_, of, record()); }
  Result<TearReport> operator()(const Bore& of) { return instance_.drill(pose_, of, record()); }
  Result<TearReport> operator()(const BeginStrokeCommand& of) {
    return report_of(instance_.begin_stroke(pose_, of.blade, of.options, of.sampling));
  }
  Result<TearReport> operator()(const ExtendStrokeCommand& of) {
    return instance_.extend_stroke(pose_, of.blade, of.seconds, record());
  }
  Result<TearReport> operator()(const EndStrokeCommand&) { return instance_.end_stroke(record()); }
  Result<TearReport> operator()(const CancelStrokeCommand&) {
    return report_of(instance_.cancel_stroke(record()));
  }
  Result<TearReport> operator()(const UndoCommand&) { return report_of(instance_.undo(record())); }
  Result<TearReport> operator()(const RedoCommand&) { return report_of(instance_.redo(record())); }
  Result<TearReport> operator()(const WeightsOperation& of) {
    return instance_.apply(of, changes_);
  }

 private:
  static Result<TearReport> report_of(const Status& status) {
    return status ? Result<TearReport>(TearReport()) : Result<TearReport>(status);
  }
  ChangeRecord* record() { return changes_ == nullptr ? nullptr : &changes_->emplace_back(); }

  CharacterInstance& instance_;
  const ModelPose& pose_;
  std::vector<ChangeRecord>* changes_;
};

Status out_of_memory() {
  return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
}

}  // namespace

Status Actor::play(Index clip, const PlayOptions& options, double now) {
  const std::size_t count = instance.character().clips.size();
  if (clip >= count)
    return Status::failure(StatusCode::index_out_of_range, clip,
                           "there is no clip %u; the character has %zu", clip, count);
  if (!std::isfinite(options.start) || !std::isfinite(options.speed))
    return Status::failure(StatusCode::non_finite_value, kNone,
                           "start and speed of a clip must be finite");
  playback_.start(clip, options, now);
  return {};
}

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

void Actor::fall_idle() noexcept {
  if (!has_new_pose_) pose_ = {};
  if (!playback_.is_playing()) playback_ = {};
  commands = {};
  results = {};
}

bool Actor::is_busy() const {
  return playback_.is_playing() || has_new_pose_ || instance.needs_step() ||
         instance.needs_draw() || is_being_torn();
}

Status Actor::animate() {
  const Character& character = *instance.asset()->character();
  playback_.advance(character, now_);
  if (!playback_.needs_sample()) {
    if (!pose().model_from_bone.empty()) return {};
    Result<ModelPose> rest = rest_pose(character);
    if (!rest) return rest.error();
    pose_ = std::move(*rest);
    return {};
  }
  frame.was_sampled = true;
  has_new_pose_ = true;
  return playback_.sample(character, pose_);
}

void Actor::apply(const QueuedCommand& queued) {
  CommandResult& result = results.emplace_back();
  result.command = queued.id;
  result.instance = queued.instance;
  std::vector<ChangeRecord>* const changes =
      queued.options.wants_changes ? &result.changes : nullptr;
  Result<TearReport> report = std::visit(CommandCalls(instance, pose(), changes), queued.command);
  if (report)
    result.report = std::move(*report);
  else
    result.status = report.error();
  last_operation_ = now_;
}

void Actor::apply_commands() {
  if (commands.empty()) return;
  const Stopwatch watch(frame.operations);
  results.reserve(commands.size());
  for (const QueuedCommand& queued : commands) apply(queued);
  commands.clear();
}

void Actor::update(const Frame& of) {
  frame = {};
  results.clear();
  frame.was_waiting = !of.is_its_turn && !is_being_torn();
  if (frame.was_waiting) return;
  const double seconds = of.now - now_;
  now_ = of.now;
  try {
    frame.status = move(seconds);
    if (frame.status && is_visible_ && instance.needs_draw()) draw(of.parallel_for);
  } catch (const std::bad_alloc&) {
    frame.status = out_of_memory();
  }
}

Status Actor::move(double seconds) {
  {
    const Stopwatch watch(frame.animation);
    if (Status status = animate(); !status) return status;
  }
  apply_commands();
  if (!has_new_pose_ && !instance.needs_step()) return {};
  const Stopwatch watch(frame.tissue);
  Status status = instance.advance(pose(), seconds);
  frame.was_advanced = static_cast<bool>(status);
  if (status) has_new_pose_ = false;
  return status;
}

void Actor::draw(const ParallelFor& parallel_for) {
  const Stopwatch watch(frame.drawing);
  frame.status = instance.draw(parallel_for);
  frame.was_drawn = static_cast<bool>(frame.status);
  if (frame.was_drawn) frame.vertices = instance.drawn_vertices();
}

}  // namespace sunder::scene
