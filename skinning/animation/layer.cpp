#include "skinning/animation/layer.h"

#include <algorithm>
#include <cmath>

#include "skinning/animation/transform_blend.h"
#include "skinning/internal/sample_channel.h"

namespace sunder::animation {
namespace {

double eased(Easing easing, double t) {
  switch (easing) {
    case Easing::linear: return t;
    case Easing::smooth: return t * t * (3.0 - 2.0 * t);
    case Easing::ease_in: return t * t;
    case Easing::ease_out: return t * (2.0 - t);
  }
  return t;
}

float share_of(const Layer& layer, std::size_t bone) {
  const float weight = layer.fade.weight();
  return layer.options.mask == nullptr ? weight : weight * layer.options.mask->bones[bone];
}

float morph_share(const Layer& layer) {
  const float weight = layer.fade.weight();
  return layer.options.mask == nullptr ? weight : weight * layer.options.mask->morph_weights;
}

void blend_number(float other, float t, float& number) {
  number = t >= 1.0f ? other : number + t * (other - number);
}

/// Blends those parts of a bone that the clip animates.
void blend_parts(const AnimatedBone& animated, const BoneTransform& other, float t,
                 BoneTransform& transform) {
  BoneTransform wanted = transform;
  if (animated.has_translation) wanted.translation = other.translation;
  if (animated.has_rotation) wanted.rotation = other.rotation;
  if (animated.has_scale) wanted.scale = other.scale;
  blend_transform(wanted, t, transform);
}

void apply_animated(Layer& layer, Pose& other, Pose& pose) {
  layer.sample(other);
  for (const AnimatedBone& animated : layer.parts.bones)
    blend_parts(animated, other.parent_from_bone[animated.bone], share_of(layer, animated.bone),
                pose.parent_from_bone[animated.bone]);
  const float share = morph_share(layer);
  for (const std::uint32_t i : layer.parts.morph_weights)
    blend_number(other.morph_weights[i], share, pose.morph_weights[i]);
}

void apply_whole(Layer& layer, Pose& other, Pose& pose) {
  layer.sample(other);
  for (std::size_t bone = 0; bone < pose.parent_from_bone.size(); ++bone)
    blend_transform(other.parent_from_bone[bone], share_of(layer, bone),
                    pose.parent_from_bone[bone]);
  const float share = morph_share(layer);
  for (std::size_t i = 0; i < pose.morph_weights.size(); ++i)
    blend_number(other.morph_weights[i], share, pose.morph_weights[i]);
}

void apply_additive(Layer& layer, const Pose& rest, Pose& other, PoseDelta& delta, Pose& pose) {
  layer.sample(other);
  const Pose& reference = layer.options.reference == nullptr ? rest : *layer.options.reference;
  // Sizes and weights were checked when the layer started, and `delta` fits.
  (void)make_additive(other, reference, delta);
  (void)add(delta, layer.fade.weight(), pose, layer.options.mask.get());
}

}  // namespace

float Fade::weight() const {
  if (is_over()) return to;
  const double t = eased(easing, elapsed / seconds);
  return static_cast<float>(static_cast<double>(from) +
                            t * (static_cast<double>(to) - static_cast<double>(from)));
}

AnimatedParts animated_parts(const Clip& clip) {
  AnimatedParts parts;
  for (const Channel& channel : clip.channels) {
    parts.duration = std::max(parts.duration, static_cast<double>(channel.times.back()));
    parts.is_constant &= channel.times.size() == 1;
    if (channel.target == ChannelTarget::morph_weights) {
      for (std::uint32_t i = 0; i < channel.width; ++i)
        parts.morph_weights.push_back(channel.index + i);
      continue;
    }
    parts.bones.push_back({channel.index, channel.target == ChannelTarget::translation,
                           channel.target == ChannelTarget::rotation,
                           channel.target == ChannelTarget::scale});
  }
  std::stable_sort(parts.bones.begin(), parts.bones.end(),
                   [](const AnimatedBone& a, const AnimatedBone& b) { return a.bone < b.bone; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < parts.bones.size(); ++i) {
    const AnimatedBone next = parts.bones[i];
    if (kept == 0 || parts.bones[kept - 1].bone != next.bone) {
      parts.bones[kept++] = next;
      continue;
    }
    AnimatedBone& same = parts.bones[kept - 1];
    same.has_translation |= next.has_translation;
    same.has_rotation |= next.has_rotation;
    same.has_scale |= next.has_scale;
  }
  parts.bones.resize(kept);
  auto& morphs = parts.morph_weights;
  std::sort(morphs.begin(), morphs.end());
  morphs.erase(std::unique(morphs.begin(), morphs.end()), morphs.end());
  return parts;
}

double Layer::period() const {
  return options.mode == PlayMode::ping_pong ? 2.0 * parts.duration : parts.duration;
}

double Layer::time() const {
  return phase <= parts.duration ? phase : 2.0 * parts.duration - phase;
}

bool Layer::is_over() const {
  if (options.mode != PlayMode::once) return false;
  return options.speed < 0.0 ? phase <= 0.0 : phase >= parts.duration;
}

bool Layer::is_opaque() const {
  return options.kind == LayerKind::whole && options.mask == nullptr && fade.weight() >= 1.0f;
}

void Layer::seek(double time) { phase = std::clamp(time, 0.0, parts.duration); }

void Layer::start_fade(float weight, double seconds, Easing easing) {
  fade = {fade.weight(), weight, 0.0, seconds, easing};
}

bool Layer::advance(double seconds) {
  const float weight = fade.weight();
  const bool has_moved = advance_clip(seconds);
  if (!fade.is_over()) fade.elapsed += seconds;
  begin_last_fade();
  const float now = fade.weight();
  return weight != now || (has_moved && now > 0.0f);
}

bool Layer::advance_clip(double seconds) {
  if (parts.duration <= 0.0 || options.speed == 0.0) return false;
  const double before = phase;
  double next = phase + seconds * options.speed;
  if (options.mode == PlayMode::once) {
    next = std::clamp(next, 0.0, parts.duration);
  } else if (next < 0.0 || next > period()) {
    next = std::fmod(next, period());
    if (next < 0.0) next += period();
  }
  if (!std::isfinite(next)) next = 0.0;  // speeds whose product with the time overflows
  phase = next;
  return phase != before && !parts.is_constant;
}

/// The end of a clip that is played once and fades out.
void Layer::begin_last_fade() {
  if (options.mode != PlayMode::once || options.fade_out <= 0.0 || ends_after_fade) return;
  if (options.speed == 0.0) return;
  const double left = options.speed < 0.0 ? phase : parts.duration - phase;
  const double seconds = left / std::abs(options.speed);
  if (seconds > options.fade_out) return;
  start_fade(0.0f, seconds, options.easing);
  ends_after_fade = true;
}

void Layer::sample(Pose& pose) {
  const double at = time();
  for (std::size_t i = 0; i < clip->channels.size(); ++i) {
    const Channel& channel = clip->channels[i];
    if (channel.target == ChannelTarget::morph_weights)
      skinning::sample_channel(channel, at, cursors[i], pose.morph_weights);
    else
      skinning::sample_channel(channel, at, cursors[i], pose.parent_from_bone[channel.index]);
  }
}

void apply(Layer& layer, const Pose& rest, Pose& other, PoseDelta& delta, Pose& pose) {
  if (layer.fade.weight() <= 0.0f) return;
  if (layer.options.kind == LayerKind::animated) {
    apply_animated(layer, other, pose);
    return;
  }
  if (layer.is_opaque()) {
    pose = rest;
    layer.sample(pose);
    return;
  }
  other = rest;
  if (layer.options.kind == LayerKind::whole)
    apply_whole(layer, other, pose);
  else
    apply_additive(layer, rest, other, delta, pose);
}

}  // namespace sunder::animation
