#include <sunder/animation/clip_editor.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "core/internal/or_throw.h"
#include "core/internal/out_of_memory.h"
#include "core/internal/validate_clip.h"
#include "skinning/animation/key_track.h"
#include "skinning/animation/reduce_keys.h"
#include "skinning/internal/sample_channel.h"

namespace sunder {

using animation::KeyTrack;

struct ClipEditor::State {
  struct MorphRange {
    std::uint32_t first = 0, count = 0;
  };

  std::shared_ptr<const Character> character;
  std::string name;
  ClipEditorOptions options;
  Pose rest;
  std::vector<MorphRange> morphs;  ///< Of each mesh with targets, once.
  std::vector<KeyTrack> tracks;
  /// Times at which poses were kept: at rest, they need no track, but later tracks must know them.
  std::set<float> kept_times;

  [[nodiscard]] std::set<float> key_times() const;
  [[nodiscard]] std::optional<float> nearest_key(double time) const;
  [[nodiscard]] Pose pose_at(float time) const;
  [[nodiscard]] std::vector<KeyTrack> new_tracks(float time, const Pose& pose,
                                                 KeyedTracks wanted) const;
  void add_rest_keys(const std::set<float>& times, float time, KeyedTracks wanted,
                     KeyTrack& track) const;
};

namespace {

Status no_key(double time) {
  return Status::failure(StatusCode::not_found, kNone, "there is no key at %g s", time);
}

Status check_time(double time) {
  if (!std::isfinite(time))
    return Status::failure(StatusCode::non_finite_value, kNone, "the time of a key is not finite");
  if (time < 0.0 || !std::isfinite(static_cast<float>(time)))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the time of a key is %g s, but must be >= 0", time);
  return {};
}

Status check_pose(const Pose& pose, const Pose& rest) {
  if (pose.parent_from_bone.size() != rest.parent_from_bone.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu bones, the character has %zu",
                           pose.parent_from_bone.size(), rest.parent_from_bone.size());
  if (pose.morph_weights.size() != rest.morph_weights.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu morph weights, the character has %zu",
                           pose.morph_weights.size(), rest.morph_weights.size());
  for (std::uint32_t bone = 0; bone < pose.parent_from_bone.size(); ++bone) {
    const BoneTransform& local = pose.parent_from_bone[bone];
    if (!local.translation.allFinite() || !local.rotation.coeffs().allFinite() ||
        !local.scale.allFinite())
      return Status::failure(StatusCode::non_finite_value, bone,
                             "the pose of bone %u is not finite", bone);
  }
  for (std::uint32_t i = 0; i < pose.morph_weights.size(); ++i)
    if (!std::isfinite(pose.morph_weights[i]))
      return Status::failure(StatusCode::non_finite_value, i,
                             "morph weight %u of the pose is not finite", i);
  return {};
}

}  // namespace

/// Times of all keys, ascending.
std::set<float> ClipEditor::State::key_times() const {
  std::set<float> times = kept_times;
  for (const KeyTrack& track : tracks)
    times.insert(track.channel.times.begin(), track.channel.times.end());
  return times;
}

/// The nearest key that snaps a time.
std::optional<float> ClipEditor::State::nearest_key(double time) const {
  std::optional<float> nearest;
  double least = options.snap;
  const auto consider = [&](float key) {
    const double distance = std::abs(static_cast<double>(key) - time);
    if (!(distance <= least) || (nearest && distance == least)) return;
    least = distance;
    nearest = key;
  };
  const auto near = static_cast<float>(std::clamp(time, -1e30, 1e30));
  for (const KeyTrack& track : tracks) {
    const auto& times = track.channel.times;
    const std::size_t after = track.lower_bound(near);
    if (after < times.size()) consider(times[after]);
    if (after > 0) consider(times[after - 1]);
  }
  const auto after = kept_times.lower_bound(near);
  if (after != kept_times.end()) consider(*after);
  if (after != kept_times.begin()) consider(*std::prev(after));
  return nearest;
}

Pose ClipEditor::State::pose_at(float time) const {
  Pose pose = rest;
  for (const KeyTrack& track : tracks) {
    const Channel& channel = track.channel;
    if (channel.target == ChannelTarget::morph_weights)
      skinning::sample_channel(channel, static_cast<double>(time), pose.morph_weights);
    else
      skinning::sample_channel(channel, static_cast<double>(time),
                               pose.parent_from_bone[channel.index]);
  }
  return pose;
}

/// Tracks for what the clip does not animate yet: all of it, or what differs from rest.
std::vector<KeyTrack> ClipEditor::State::new_tracks(float time, const Pose& pose,
                                                    KeyedTracks wanted) const {
  std::vector<std::uint8_t> parts(rest.parent_from_bone.size(), 0);
  std::vector<bool> morph_weights(rest.morph_weights.size(), false);
  for (const KeyTrack& track : tracks) {
    const Channel& channel = track.channel;
    if (channel.target != ChannelTarget::morph_weights)
      parts[channel.index] |=
          static_cast<std::uint8_t>(1u << static_cast<unsigned>(channel.target));
    else
      std::fill_n(morph_weights.begin() + channel.index, channel.width, true);
  }
  std::vector<KeyTrack> added;
  std::optional<std::set<float>> times;  // Asked for once, if at all.
  const auto consider = [&](ChannelTarget target, std::uint32_t index, std::uint32_t width) {
    KeyTrack track = animation::make_track(target, index, width, options.interpolation);
    if (wanted != KeyedTracks::all && animation::is_same_value(track.channel, pose, rest)) return;
    if (!times) times = key_times();
    track.make_room(3);
    add_rest_keys(*times, time, wanted, track);
    track.put(time, pose);
    added.push_back(std::move(track));
  };
  for (std::uint32_t bone = 0; bone < parts.size(); ++bone)
    for (const auto& [target, width] :
         {std::pair(ChannelTarget::translation, 3u), std::pair(ChannelTarget::rotation, 4u),
          std::pair(ChannelTarget::scale, 3u)})
      if ((parts[bone] >> static_cast<unsigned>(target) & 1u) == 0) consider(target, bone, width);
  for (const MorphRange& range : morphs) {
    const auto first = morph_weights.begin() + range.first;
    if (std::find(first, first + range.count, true) == first + range.count)
      consider(ChannelTarget::morph_weights, range.first, range.count);
  }
  return added;
}

/// The values of a new track at the other keys: at all of them, so that their poses stay when the
/// track gets further keys, or at those around its first one.
void ClipEditor::State::add_rest_keys(const std::set<float>& times, float time, KeyedTracks wanted,
                                      KeyTrack& track) const {
  if (wanted != KeyedTracks::changed) {
    track.make_room(times.size() + 1);
    for (const float other : times) track.put(other, rest);
    return;
  }
  const auto after = times.upper_bound(time), at = times.lower_bound(time);
  if (at != times.begin()) track.put(*std::prev(at), rest);
  if (after != times.end()) track.put(*after, rest);
}

Result<ClipEditor> ClipEditor::create(std::shared_ptr<const Character> character, std::string name,
                                      const ClipEditorOptions& options) {
  if (character == nullptr)
    return Status::failure(StatusCode::empty_input, kNone, "there is no character");
  if (!(options.snap >= 0.0) || !std::isfinite(options.snap))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the time within which keys snap is %g s, but must be >= 0",
                           options.snap);
  return or_out_of_memory([&]() -> Result<ClipEditor> {
    auto state = std::make_unique<State>();
    state->rest = or_throw(local_rest_pose(*character));
    std::set<std::uint32_t> seen;
    for (const Mesh& mesh : character->meshes)
      if (!mesh.morph_targets.empty() && seen.insert(mesh.first_morph_weight).second)
        state->morphs.push_back(
            {mesh.first_morph_weight, static_cast<std::uint32_t>(mesh.morph_targets.size())});
    state->character = std::move(character);
    state->name = std::move(name);
    state->options = options;
    return ClipEditor(std::move(state));
  });
}

Result<ClipEditor> ClipEditor::create(std::shared_ptr<const Character> character, const Clip& clip,
                                      const ClipEditorOptions& options) {
  if (character != nullptr)
    if (const Status status = validate_clip(*character, clip); !status) return status;
  return or_out_of_memory([&]() -> Result<ClipEditor> {
    Result<ClipEditor> editor = create(std::move(character), clip.name, options);
    if (!editor) return editor;
    for (const Channel& channel : clip.channels) editor->state_->tracks.push_back({channel, false});
    return editor;
  });
}

ClipEditor::ClipEditor(std::unique_ptr<State> state) : state_(std::move(state)) {}
ClipEditor::~ClipEditor() = default;
ClipEditor::ClipEditor(ClipEditor&&) noexcept = default;
ClipEditor& ClipEditor::operator=(ClipEditor&&) noexcept = default;

Status ClipEditor::insert(double time, const Pose& pose, KeyedTracks wanted) {
  State& state = *state_;
  if (const Status status = check_time(time); !status) return status;
  if (const Status status = check_pose(pose, state.rest); !status) return status;
  return or_out_of_memory([&]() -> Status {
    const float at = state.nearest_key(time).value_or(static_cast<float>(time));
    // All memory comes first, so that a failure changes nothing.
    std::vector<KeyTrack> added = state.new_tracks(at, pose, wanted);
    const Pose before = wanted == KeyedTracks::changed ? state.pose_at(at) : Pose();
    for (KeyTrack& track : state.tracks) track.make_room(1);
    state.tracks.reserve(state.tracks.size() + added.size());
    state.kept_times.insert(at);  // After everything else that can fail.
    for (KeyTrack& track : state.tracks)
      if (wanted != KeyedTracks::changed || !animation::is_same_value(track.channel, pose, before))
        track.put(at, pose);
    for (KeyTrack& track : added) state.tracks.push_back(std::move(track));
    return {};
  });
}

Status ClipEditor::move(double from, double to) {
  State& state = *state_;
  if (const Status status = check_time(to); !status) return status;
  return or_out_of_memory([&]() -> Status {
    const std::optional<float> source = state.nearest_key(from);
    if (!source) return no_key(from);
    float target = static_cast<float>(to);
    double least = state.options.snap;
    for (const float time : state.key_times()) {
      const double distance = std::abs(static_cast<double>(time) - to);
      if (time == *source || distance > least) continue;  // Its own time does not hold it back.
      least = distance;
      target = time;
    }
    std::set<float> kept_times = state.kept_times;
    if (kept_times.erase(*source) != 0) kept_times.insert(target);
    std::vector<KeyTrack> moved = state.tracks;
    for (KeyTrack& track : moved)
      if (track.has_key(*source)) track.move(track.lower_bound(*source), target);
    state.tracks.swap(moved);
    state.kept_times.swap(kept_times);
    return {};
  });
}

Status ClipEditor::remove(double time) {
  State& state = *state_;
  return or_out_of_memory([&]() -> Status {
    const std::optional<float> at = state.nearest_key(time);
    if (!at) return no_key(time);
    for (KeyTrack& track : state.tracks)
      if (track.has_key(*at)) track.remove(track.lower_bound(*at));
    state.kept_times.erase(*at);
    std::erase_if(state.tracks, [](const KeyTrack& track) { return track.channel.times.empty(); });
    return {};
  });
}

Status ClipEditor::reduce(const ReduceOptions& options) {
  if (!(options.metres >= 0.0) || !(options.radians >= 0.0) || !(options.factor >= 0.0))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the tolerances %g, %g and %g must be >= 0", options.metres,
                           options.radians, options.factor);
  return or_out_of_memory([&]() -> Status {
    std::vector<KeyTrack> reduced = state_->tracks;
    for (KeyTrack& track : reduced) animation::reduce_keys(track.channel, options);
    state_->tracks.swap(reduced);
    state_->kept_times.clear();  // Where no key is left, nothing is kept.
    return {};
  });
}

std::vector<float> ClipEditor::key_times() const {
  const std::set<float> times = state_->key_times();
  return {times.begin(), times.end()};
}

Result<std::shared_ptr<const Clip>> ClipEditor::snapshot() const {
  const State& state = *state_;
  if (state.tracks.empty())
    return Status::failure(StatusCode::empty_input, kNone,
                           "clip '%.60s' has no key that is not at rest", state.name.c_str());
  return or_out_of_memory([&]() -> Result<std::shared_ptr<const Clip>> {
    auto clip = std::make_shared<Clip>();
    clip->name = state.name;
    clip->channels.reserve(state.tracks.size());
    for (const KeyTrack& track : state.tracks) {
      clip->channels.push_back(track.channel);
      clip->duration = std::max(clip->duration, track.channel.times.back());
    }
    return std::shared_ptr<const Clip>(std::move(clip));
  });
}

}  // namespace sunder
