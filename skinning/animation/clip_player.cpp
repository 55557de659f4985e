#include <sunder/animation/clip_player.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/internal/or_throw.h"
#include "core/internal/out_of_memory.h"
#include "core/internal/validate_clip.h"
#include "skinning/animation/layer.h"

namespace sunder {

using animation::Layer;

std::shared_ptr<const Clip> clip_of(std::shared_ptr<const Character> character,
                                    std::uint32_t clip) {
  if (character == nullptr || clip >= character->clips.size()) return nullptr;
  const Clip* const found = &character->clips[clip];
  return {std::move(character), found};
}

struct ClipPlayer::State {
  struct Slot {
    Layer layer;
    std::uint32_t generation = 0;
  };

  std::shared_ptr<const Character> character;
  Pose rest;
  std::vector<Slot> slots;
  std::vector<std::uint32_t> playing;  ///< Slots, the lowest layer first.
  std::vector<std::uint32_t> unused;   ///< Slots.
  std::uint64_t revision = 1, evaluated = 0;
  Pose other;       ///< Scratch.
  PoseDelta delta;  ///< Scratch.

  [[nodiscard]] Layer* find(LayerId id) {
    const bool exists = id.slot < slots.size() && slots[id.slot].generation == id.generation &&
                        slots[id.slot].layer.clip != nullptr;
    return exists ? &slots[id.slot].layer : nullptr;
  }
  [[nodiscard]] Status check(const Clip* clip, const LayerOptions& options) const;
  [[nodiscard]] LayerId start(std::shared_ptr<const Clip> clip, const LayerOptions& options);
  void end(std::uint32_t slot);
  void end_finished();
  void end_replaced();
  [[nodiscard]] std::size_t first_visible() const;
};

namespace {

Status no_layer(LayerId id) {
  return Status::failure(StatusCode::not_found, id.slot, "layer %u has ended or never existed",
                         id.slot);
}

bool is_blend_share(float value) { return value >= 0.0f && value <= 1.0f; }
bool is_duration(double value) { return std::isfinite(value) && value >= 0.0; }

Status check_fade(float weight, double seconds) {
  if (is_blend_share(weight) && is_duration(seconds)) return {};
  return Status::failure(StatusCode::invalid_argument, kNone,
                         "a fade to %g in %g s: the weight must be in [0, 1], the time >= 0",
                         static_cast<double>(weight), seconds);
}

bool is_finite(const Pose& pose) {
  return std::all_of(pose.parent_from_bone.begin(), pose.parent_from_bone.end(),
                     [](const BoneTransform& bone) {
                       return bone.translation.allFinite() && bone.scale.allFinite() &&
                              bone.rotation.coeffs().allFinite();
                     }) &&
         std::all_of(pose.morph_weights.begin(), pose.morph_weights.end(),
                     [](float weight) { return std::isfinite(weight); });
}

Status check_mask(const BoneMask& mask, std::size_t bones) {
  if (mask.bones.size() != bones)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the mask of a layer has %zu bones, the character has %zu",
                           mask.bones.size(), bones);
  for (std::uint32_t bone = 0; bone < bones; ++bone)
    if (!is_blend_share(mask.bones[bone]) || !is_blend_share(mask.morph_weights))
      return Status::failure(StatusCode::invalid_argument, bone,
                             "the mask of a layer leaves [0, 1] at bone %u or for morph weights",
                             bone);
  return {};
}

/// Whether each slot either plays one layer or is unused, and all numbers are in range.
Status check_slots(const ClipPlayerState& kept) {
  std::vector<std::uint8_t> is_seen(kept.generations.size(), 0);
  const auto see = [&](std::uint32_t slot) {
    return slot < is_seen.size() && std::exchange(is_seen[slot], 1) == 0;
  };
  for (const std::uint32_t slot : kept.unused)
    if (!see(slot))
      return Status::failure(StatusCode::index_out_of_range, slot, "slot %u cannot be unused",
                             slot);
  LayerKind kind = LayerKind::whole;
  for (const ClipPlayerState::Layer& layer : kept.layers) {
    const auto& [from, to, elapsed, seconds, easing] = layer.fade;
    const bool is_sound = is_blend_share(from) && is_blend_share(to) && is_duration(elapsed) &&
                          is_duration(seconds) && is_duration(layer.phase) &&
                          layer.options.kind >= kind;
    if (!is_sound || !see(layer.slot))
      return Status::failure(StatusCode::invalid_argument, layer.slot,
                             "the layer in slot %u does not fit the others", layer.slot);
    kind = layer.options.kind;
  }
  if (std::find(is_seen.begin(), is_seen.end(), 0) == is_seen.end()) return {};
  return Status::failure(StatusCode::invalid_argument, kNone,
                         "a slot neither plays a layer nor is unused");
}

}  // namespace

Status ClipPlayer::State::check(const Clip* clip, const LayerOptions& options) const {
  if (clip == nullptr)
    return Status::failure(StatusCode::empty_input, kNone, "there is no clip to play");
  if (const Status status = validate_clip(*character, *clip); !status) return status;
  if (!std::isfinite(options.time) || !std::isfinite(options.speed))
    return Status::failure(StatusCode::non_finite_value, kNone,
                           "the time or the speed of a layer is not finite");
  if (const Status status = check_fade(options.weight, options.fade_in); !status) return status;
  if (!is_duration(options.fade_out))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "fade_out is %g, but must be finite and >= 0", options.fade_out);
  if (options.reference != nullptr &&
      (options.reference->parent_from_bone.size() != rest.parent_from_bone.size() ||
       options.reference->morph_weights.size() != rest.morph_weights.size()))
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the reference pose of a layer is not of this character");
  if (options.reference != nullptr && !is_finite(*options.reference))
    return Status::failure(StatusCode::non_finite_value, kNone,
                           "the reference pose of a layer is not finite");
  return options.mask == nullptr ? Status()
                                 : check_mask(*options.mask, rest.parent_from_bone.size());
}

/// Everything that can fail for lack of memory comes before the first change.
LayerId ClipPlayer::State::start(std::shared_ptr<const Clip> clip, const LayerOptions& options) {
  animation::AnimatedParts parts = animation::animated_parts(*clip);
  if (unused.empty()) {
    playing.reserve(slots.size() + 1);
    unused.reserve(slots.size() + 1);
    slots.emplace_back();
    unused.push_back(static_cast<std::uint32_t>(slots.size() - 1));
  }
  const std::uint32_t slot = unused.back();
  Layer& layer = slots[slot].layer;
  layer.cursors.assign(clip->channels.size(), 0);
  unused.pop_back();
  layer.clip = std::move(clip);
  layer.parts = std::move(parts);
  layer.options = options;
  layer.ends_after_fade = layer.ends_others_after_fade = false;
  layer.fade = {options.fade_in > 0.0 ? 0.0f : options.weight, options.weight, 0.0, options.fade_in,
                options.easing};
  layer.seek(options.time);
  const auto above = std::find_if(playing.begin(), playing.end(), [&](std::uint32_t started) {
    return slots[started].layer.options.kind > options.kind;
  });
  playing.insert(above, slot);
  ++revision;
  return {slot, slots[slot].generation};
}

void ClipPlayer::State::end(std::uint32_t slot) {
  Layer& layer = slots[slot].layer;
  layer.clip = nullptr;
  layer.options.mask = nullptr;
  layer.options.reference = nullptr;
  ++slots[slot].generation;
  unused.push_back(slot);
}

void ClipPlayer::State::end_finished() {
  const auto is_finished = [&](std::uint32_t slot) {
    const Layer& layer = slots[slot].layer;
    return layer.ends_after_fade && layer.fade.is_over();
  };
  for (const std::uint32_t slot : playing)
    if (is_finished(slot)) end(slot);
  std::erase_if(playing, [&](std::uint32_t slot) { return slots[slot].layer.clip == nullptr; });
}

/// Ends the layers over which a later one has faded in completely.
void ClipPlayer::State::end_replaced() {
  for (std::size_t top = playing.size(); top-- > 0;) {
    Layer& above = slots[playing[top]].layer;
    if (!above.ends_others_after_fade || !above.fade.is_over()) continue;
    above.ends_others_after_fade = false;
    if (above.options.mask != nullptr) ++revision;  // It may have shown what is below.
    for (std::size_t i = 0; i < top; ++i) {
      const Layer& below = slots[playing[i]].layer;
      if (below.options.kind == LayerKind::whole && below.options.mask == above.options.mask)
        end(playing[i]);
    }
    std::erase_if(playing, [&](std::uint32_t slot) { return slots[slot].layer.clip == nullptr; });
    return;  // The layers below are gone, and with them what they would have ended.
  }
}

/// Position in `playing` of the highest layer that hides all below it.
std::size_t ClipPlayer::State::first_visible() const {
  for (std::size_t i = playing.size(); i-- > 0;)
    if (slots[playing[i]].layer.is_opaque()) return i;
  return 0;
}

Result<ClipPlayer> ClipPlayer::create(std::shared_ptr<const Character> character) {
  if (character == nullptr)
    return Status::failure(StatusCode::empty_input, kNone, "there is no character");
  return or_out_of_memory([&]() -> Result<ClipPlayer> {
    auto state = std::make_unique<State>();
    state->rest = or_throw(local_rest_pose(*character));
    state->other = state->rest;
    state->delta.bones.resize(state->rest.parent_from_bone.size());
    state->delta.morph_weights.resize(state->rest.morph_weights.size());
    state->character = std::move(character);
    return ClipPlayer(std::move(state));
  });
}

ClipPlayer::ClipPlayer(std::unique_ptr<State> state) : state_(std::move(state)) {}
ClipPlayer::~ClipPlayer() = default;
ClipPlayer::ClipPlayer(ClipPlayer&&) noexcept = default;
ClipPlayer& ClipPlayer::operator=(ClipPlayer&&) noexcept = default;

Result<LayerId> ClipPlayer::play(std::shared_ptr<const Clip> clip, const LayerOptions& options) {
  if (const Status status = state_->check(clip.get(), options); !status) return status;
  return or_out_of_memory(
      [&]() -> Result<LayerId> { return state_->start(std::move(clip), options); });
}

Result<LayerId> ClipPlayer::cross_fade(std::shared_ptr<const Clip> clip,
                                       const LayerOptions& options) {
  if (options.kind != LayerKind::whole || options.weight != 1.0f)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "only a layer of kind `whole` and weight 1 can replace others");
  const Result<LayerId> id = play(std::move(clip), options);
  if (id) {
    state_->find(*id)->ends_others_after_fade = true;
    state_->end_replaced();
  }
  return id;
}

Status ClipPlayer::replace_clip(LayerId id, std::shared_ptr<const Clip> clip) {
  Layer* const layer = state_->find(id);
  if (layer == nullptr) return no_layer(id);
  if (const Status status = state_->check(clip.get(), layer->options); !status) return status;
  return or_out_of_memory([&]() -> Status {
    animation::AnimatedParts parts = animation::animated_parts(*clip);
    layer->cursors.assign(clip->channels.size(), 0);
    const bool is_returning = layer->phase > layer->parts.duration;
    const double time = std::min(layer->time(), parts.duration);
    layer->parts = std::move(parts);
    layer->clip = std::move(clip);
    layer->phase = is_returning ? layer->period() - time : time;
    ++state_->revision;
    return {};
  });
}

Status ClipPlayer::fade(LayerId id, float weight, double seconds, Easing easing) {
  Layer* const layer = state_->find(id);
  if (layer == nullptr) return no_layer(id);
  if (const Status status = check_fade(weight, seconds); !status) return status;
  const float before = layer->fade.weight();
  layer->start_fade(weight, seconds, easing);
  layer->ends_after_fade = layer->ends_others_after_fade = false;
  if (layer->fade.weight() != before) ++state_->revision;
  return {};
}

Status ClipPlayer::stop(LayerId id, double seconds, Easing easing) {
  if (const Status status = fade(id, 0.0f, seconds, easing); !status) return status;
  state_->find(id)->ends_after_fade = true;
  state_->end_finished();
  return {};
}

void ClipPlayer::stop_all() {
  if (state_->playing.empty()) return;
  for (const std::uint32_t slot : state_->playing) state_->end(slot);
  state_->playing.clear();
  ++state_->revision;
}

Status ClipPlayer::seek(LayerId id, double time) {
  Layer* const layer = state_->find(id);
  if (layer == nullptr) return no_layer(id);
  if (!std::isfinite(time))
    return Status::failure(StatusCode::non_finite_value, kNone, "the time to seek is not finite");
  layer->seek(time);
  ++state_->revision;
  return {};
}

Status ClipPlayer::set_speed(LayerId id, double speed) {
  Layer* const layer = state_->find(id);
  if (layer == nullptr) return no_layer(id);
  if (!std::isfinite(speed))
    return Status::failure(StatusCode::non_finite_value, kNone, "the speed is not finite");
  layer->options.speed = speed;
  return {};
}

std::uint32_t ClipPlayer::layer_count() const {
  return static_cast<std::uint32_t>(state_->playing.size());
}

Result<LayerState> ClipPlayer::layer(LayerId id) const {
  const Layer* const layer = state_->find(id);
  if (layer == nullptr) return no_layer(id);
  return LayerState{layer->time(), layer->fade.weight(), layer->is_over()};
}

Result<ClipPlayerState> ClipPlayer::state() const {
  return or_out_of_memory([&]() -> Result<ClipPlayerState> {
    ClipPlayerState kept;
    kept.unused = state_->unused;
    for (const State::Slot& slot : state_->slots) kept.generations.push_back(slot.generation);
    for (const std::uint32_t slot : state_->playing) {
      const Layer& layer = state_->slots[slot].layer;
      const animation::Fade& fade = layer.fade;
      kept.layers.push_back({slot,
                             layer.clip,
                             layer.options,
                             {fade.from, fade.to, fade.elapsed, fade.seconds, fade.easing},
                             layer.phase,
                             layer.ends_after_fade,
                             layer.ends_others_after_fade});
    }
    return kept;
  });
}

Status ClipPlayer::restore(const ClipPlayerState& kept) {
  return or_out_of_memory([&]() -> Status {
    if (Status status = check_slots(kept); !status) return status;
    std::vector<State::Slot> slots(kept.generations.size());
    std::vector<std::uint32_t> playing;
    playing.reserve(slots.size());
    for (std::size_t i = 0; i < slots.size(); ++i) slots[i].generation = kept.generations[i];
    for (const ClipPlayerState::Layer& from : kept.layers) {
      if (Status status = state_->check(from.clip.get(), from.options); !status) return status;
      Layer& layer = slots[from.slot].layer;
      layer.parts = animation::animated_parts(*from.clip);
      layer.cursors.assign(from.clip->channels.size(), 0);
      layer.clip = from.clip;
      layer.options = from.options;
      layer.fade = {from.fade.from, from.fade.to, from.fade.elapsed, from.fade.seconds,
                    from.fade.easing};
      layer.phase = from.phase;
      if (!(layer.phase <= layer.period()))
        return Status::failure(StatusCode::invalid_argument, from.slot,
                               "the layer in slot %u is beyond the end of its clip", from.slot);
      layer.ends_after_fade = from.ends_after_fade;
      layer.ends_others_after_fade = from.ends_others_after_fade;
      playing.push_back(from.slot);
    }
    std::vector<std::uint32_t> unused = kept.unused;
    unused.reserve(slots.size());
    state_->slots = std::move(slots);
    state_->playing = std::move(playing);
    state_->unused = std::move(unused);
    ++state_->revision;
    return {};
  });
}

Status ClipPlayer::advance(double seconds) {
  if (!std::isfinite(seconds))
    return Status::failure(StatusCode::non_finite_value, kNone, "the time step is not finite");
  if (seconds < 0.0)
    return Status::failure(StatusCode::invalid_argument, kNone, "the time step is %g s, below 0",
                           seconds);
  State& state = *state_;
  const std::size_t visible = state.first_visible();
  bool has_changed = false;
  for (std::size_t i = 0; i < state.playing.size(); ++i)
    has_changed |= state.slots[state.playing[i]].layer.advance(seconds) && i >= visible;
  if (has_changed) ++state.revision;
  state.end_finished();
  state.end_replaced();
  return {};
}

std::uint64_t ClipPlayer::revision() const { return state_->revision; }

bool ClipPlayer::has_changed() const { return state_->evaluated != state_->revision; }

Status ClipPlayer::evaluate(Pose& pose) {
  return or_out_of_memory([&]() -> Status {
    State& state = *state_;
    pose.parent_from_bone.reserve(state.rest.parent_from_bone.size());
    pose.morph_weights.reserve(state.rest.morph_weights.size());
    const std::size_t first = state.first_visible();
    if (first == state.playing.size() || !state.slots[state.playing[first]].layer.is_opaque())
      pose = state.rest;
    for (std::size_t i = first; i < state.playing.size(); ++i)
      animation::apply(state.slots[state.playing[i]].layer, state.rest, state.other, state.delta,
                       pose);
    state.evaluated = state.revision;
    return {};
  });
}

}  // namespace sunder
