#pragma once

#include <sunder/animation/clip_player.h>

#include <algorithm>

#include "scene/snapshot/pose_memory.h"

namespace sunder::scene {

// The members of what an instance plays. The structured bindings name all members, so that a new
// one is not forgotten here.

template <>
inline constexpr PlayMode kLastEnumerator<PlayMode> = PlayMode::once;
template <>
inline constexpr LayerKind kLastEnumerator<LayerKind> = LayerKind::additive;
template <>
inline constexpr Easing kLastEnumerator<Easing> = Easing::ease_out;
template <>
inline constexpr Interpolation kLastEnumerator<Interpolation> = Interpolation::cubic_spline;
template <>
inline constexpr ChannelTarget kLastEnumerator<ChannelTarget> = ChannelTarget::morph_weights;

template <class Archive>
void transfer(Archive& archive, Channel& of) {
  auto& [target, index, width, interpolation, times, values] = of;
  archive(target, index, width, interpolation, times, values);
}
template <class Archive>
void transfer(Archive& archive, Clip& of) {
  auto& [name, duration, channels] = of;
  archive(name, duration, channels);
}
template <class Archive>
void transfer(Archive& archive, BoneTransform& of) {
  auto& [translation, rotation, scale] = of;
  archive(translation, rotation, scale);
}
template <class Archive>
void transfer(Archive& archive, Pose& of) {
  auto& [parent_from_bone, morph_weights] = of;
  archive(parent_from_bone, morph_weights);
}
template <class Archive>
void transfer(Archive& archive, BoneMask& of) {
  auto& [bones, morph_weights] = of;
  archive(bones, morph_weights);
}
/// A shared object as one of its own. @param value  may be null.
template <class Archive, class T>
void transfer_shared(Archive& archive, std::shared_ptr<const T>& value) {
  bool has_value = value != nullptr;
  archive(has_value);
  if (!has_value) return;
  T copy;
  if constexpr (!Archive::kReads) copy = *value;
  archive(copy);
  if constexpr (Archive::kReads) value = std::make_shared<const T>(std::move(copy));
}
/// A clip of the character by its index, another one as a whole.
template <class Archive>
void transfer_clip(Archive& archive, std::shared_ptr<const Clip>& clip) {
  Index index = kNone;
  if constexpr (!Archive::kReads) index = archive.poses->index_of(*clip);
  archive(index);
  if (index == kNone)
    transfer_shared(archive, clip);
  else if constexpr (Archive::kReads)
    clip = archive.poses->clip(index);
}
template <class Archive>
void transfer(Archive& archive, LayerOptions& of) {
  auto& [kind, mode, time, speed, weight, fade_in, fade_out, easing, mask, reference] = of;
  archive(kind, mode, time, speed, weight, fade_in, fade_out, easing);
  transfer_shared(archive, reference);
}
template <class Archive>
void transfer(Archive& archive, ClipPlayerState::Fade& of) {
  auto& [from, to, elapsed, seconds, easing] = of;
  archive(from, to, elapsed, seconds, easing);
}
template <class Archive>
void transfer(Archive& archive, ClipPlayerState::Layer& of) {
  auto& [slot, clip, options, fade, phase, ends_after_fade, ends_others_after_fade] = of;
  archive(slot, options, fade, phase, ends_after_fade, ends_others_after_fade);
  transfer_clip(archive, clip);
}
/// Layers that share a mask share it again: a cross-fade ends those with its own mask.
template <class Archive>
void transfer(Archive& archive, ClipPlayerState& of) {
  auto& [layers, generations, unused] = of;
  archive(layers, generations, unused);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    std::shared_ptr<const BoneMask>& mask = layers[i].options.mask;
    const auto first = std::find_if(layers.begin(), layers.begin() + static_cast<std::ptrdiff_t>(i),
                                    [&](const auto& layer) { return layer.options.mask == mask; });
    auto shared = static_cast<Index>(first - layers.begin());
    archive(shared);
    if (shared < i)
      mask = layers[shared].options.mask;
    else
      transfer_shared(archive, mask);
  }
}

}  // namespace sunder::scene
