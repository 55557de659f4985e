#include "io/gltf_read/animations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "core/internal/all_finite.h"
#include "io/gltf/names.h"

namespace sunder::gltf {
namespace {

/// The reason why a channel is dropped. Thrown only inside this file: a fault in an animation drops
/// a channel, not the model.
struct Unusable {
  std::string reason;
  bool is_fault = true;  ///< false: glTF allows it and says that it is to be ignored.
};

class AnimationReader {
 public:
  AnimationReader(Reading& reading, const NodeSkeleton& nodes,
                  const std::vector<MorphRange>& morphs_of_node)
      : reading_(reading), nodes_(nodes), morphs_of_node_(morphs_of_node) {
    std::size_t targets = nodes.skeleton.bones.size();
    for (std::uint32_t node = 0; node < nodes.bone_from_node.size(); ++node) {
      has_matrix_.push_back(entry(reading.json(), "nodes", node).find("matrix").has_value());
      targets = std::max<std::size_t>(targets, morphs_of_node[node].first + std::size_t{1});
    }
    for (auto& clips : last_clip_) clips.assign(targets, 0);
  }

  Clip read(const Cursor& animation, const std::string& name) {
    Clip clip;
    clip.name = name;
    const std::string place = "clip '" + name + "'";
    const Cursor channels = animation.member("channels");
    std::optional<Cursor> samplers;
    ++clip_count_;
    for (std::uint32_t i = 0; i < channels.size(); ++i) {
      try {
        Channel channel = read_channel(animation, samplers, channels.element(i), place);
        std::uint32_t& last_clip =
            last_clip_[static_cast<std::size_t>(channel.target)][channel.index];
        if (std::exchange(last_clip, clip_count_) == clip_count_)
          throw Unusable{"an earlier channel has the same target"};
        clip.duration = std::max(clip.duration, channel.times.back());
        clip.channels.push_back(std::move(channel));
      } catch (const Unusable& unusable) {
        const std::string text = "channel " + std::to_string(i) + ": " + unusable.reason;
        if (unusable.is_fault)
          reading_.notes.dropped(StatusCode::malformed_file, i, place, text);
        else
          reading_.notes.inform(place, text);
      }
    }
    return clip;
  }

 private:
  /// @param samplers  of the animation, once a channel asked for them.
  Channel read_channel(const Cursor& animation, std::optional<Cursor>& samplers, const Cursor& at,
                       const std::string& place) {
    Channel channel;
    read_target(at.member("target"), channel);
    if (!samplers) samplers = animation.member("samplers");
    const Cursor sampler =
        samplers->element(at.member("sampler").to_index(samplers->size(), "sampler"));
    read_interpolation(sampler, channel);
    channel.times = read_times(sampler.member("input"));
    read_values(sampler.member("output"), channel);
    merge_equal_times(channel, place);
    check_rotations(channel);
    return channel;
  }

  void read_target(const Cursor& target, Channel& channel) const {
    const std::string& path = target.member("path").to_string();
    const auto node_at = target.find("node");
    if (!node_at) throw Unusable{"its target has no node", false};
    if (!node_at->json().is_number() || node_at->to_unsigned() >= nodes_.bone_from_node.size())
      throw Unusable{"its node does not exist"};
    const auto node = static_cast<std::uint32_t>(node_at->to_unsigned());
    if (nodes_.bone_from_node[node] == kNone) throw Unusable{"its node is not in the scene"};
    channel.index = nodes_.bone_from_node[node];
    if (path == "translation") {
      channel.target = ChannelTarget::translation;
    } else if (path == "rotation") {
      channel.target = ChannelTarget::rotation;
      channel.width = 4;
    } else if (path == "scale") {
      channel.target = ChannelTarget::scale;
    } else if (path == "weights") {
      channel.target = ChannelTarget::morph_weights;
      channel.index = morphs_of_node_[node].first;
      channel.width = morphs_of_node_[node].count;
      if (channel.width == 0) throw Unusable{"its node has no morph targets"};
    } else {
      throw Unusable{"unknown target path '" + path.substr(0, 40) + "'"};
    }
    if (channel.target != ChannelTarget::morph_weights && has_matrix_[node])
      throw Unusable{"its node has a matrix, which cannot be animated"};
  }

  static void read_interpolation(const Cursor& sampler, Channel& channel) {
    const auto at = sampler.find("interpolation");
    const std::string mode = at ? at->to_string() : "LINEAR";
    if (mode == "LINEAR")
      channel.interpolation = Interpolation::linear;
    else if (mode == "STEP")
      channel.interpolation = Interpolation::step;
    else if (mode == "CUBICSPLINE")
      channel.interpolation = Interpolation::cubic_spline;
    else
      throw Unusable{"unknown interpolation '" + mode.substr(0, 40) + "'"};
  }

  std::vector<float> read_times(const Cursor& input) {
    const Accessor accessor = reading_.accessors.open(input);
    if (accessor.components != 1 || accessor.is_integer())
      throw Unusable{"its key times are not floats"};
    std::vector<float> times = reading_.accessors.read_floats(accessor);
    float previous = 0.0f;
    for (const float time : times) {
      if (!std::isfinite(time) || time < 0.0f)
        throw Unusable{"a key time is negative or not finite"};
      if (time < previous) throw Unusable{"its key times decrease"};
      previous = time;
    }
    return times;
  }

  void read_values(const Cursor& output, Channel& channel) {
    const Accessor accessor = reading_.accessors.open(output);
    const std::size_t components =
        channel.target == ChannelTarget::morph_weights ? 1 : channel.width;
    const std::size_t expected =
        channel.times.size() * channel.width / components * (is_cubic(channel) ? 3 : 1);
    if (accessor.is_matrix || accessor.components != components || accessor.count != expected)
      throw Unusable{"the number of values does not match the number of key times"};
    if (accessor.is_integer() && !accessor.normalized)
      throw Unusable{"its values are integers that are not normalised"};
    channel.values = reading_.accessors.read_floats(accessor);
    if (!all_finite(channel.values)) throw Unusable{"a key value is not finite"};
  }

  static bool is_cubic(const Channel& channel) {
    return channel.interpolation == Interpolation::cubic_spline;
  }
  static std::size_t floats_per_key(const Channel& channel) {
    return std::size_t{channel.width} * (is_cubic(channel) ? 3 : 1);
  }

  /// Of several keys at one time, keeps the last: a player shows that one from then on.
  void merge_equal_times(Channel& channel, const std::string& place) {
    if (std::adjacent_find(channel.times.begin(), channel.times.end()) == channel.times.end())
      return;
    const std::size_t key_floats = floats_per_key(channel);
    std::size_t kept = 0;
    for (std::size_t key = 0; key < channel.times.size(); ++key) {
      if (key + 1 < channel.times.size() && channel.times[key + 1] == channel.times[key]) continue;
      channel.times[kept] = channel.times[key];
      std::copy_n(channel.values.begin() + static_cast<std::ptrdiff_t>(key * key_floats),
                  key_floats,
                  channel.values.begin() + static_cast<std::ptrdiff_t>(kept * key_floats));
      ++kept;
    }
    if (kept == channel.times.size()) return;
    reading_.notes.repaired(StatusCode::malformed_file, kNone, place,
                            "several keys at the same time; the last was kept",
                            static_cast<std::uint32_t>(channel.times.size() - kept));
    channel.times.resize(kept);
    channel.values.resize(kept * key_floats);
  }

  static void check_rotations(const Channel& channel) {
    if (channel.target != ChannelTarget::rotation) return;
    const std::size_t key_floats = floats_per_key(channel);
    for (std::size_t i = is_cubic(channel) ? 4 : 0; i < channel.values.size(); i += key_floats) {
      const Eigen::Vector4d key =
          Eigen::Map<const Eigen::Vector4f>(channel.values.data() + i).cast<double>();
      const double squared_length = key.squaredNorm();
      if (squared_length < 0.5 && std::sqrt(squared_length) < 1e-6)
        throw Unusable{"a rotation of length zero"};
    }
  }

  Reading& reading_;
  const NodeSkeleton& nodes_;
  const std::vector<MorphRange>& morphs_of_node_;
  std::vector<bool> has_matrix_;  ///< Per node.
  /// By target and its index, the number of the last clip with a channel for it, counted from one.
  std::array<std::vector<std::uint32_t>, 4> last_clip_;
  std::uint32_t clip_count_ = 0;
};

}  // namespace

std::vector<Clip> read_animations(Reading& reading, const NodeSkeleton& nodes,
                                  const std::vector<MorphRange>& morphs_of_node) {
  const std::size_t count = count_of(reading.json(), "animations");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i)
    names.push_back(entry(reading.json(), "animations", i).name());
  if (const std::size_t renamed = make_unique(names, "clip"); renamed > 0)
    reading.notes.inform("clips", "animations without a unique name were renamed",
                         static_cast<std::uint32_t>(renamed));
  AnimationReader reader(reading, nodes, morphs_of_node);
  std::vector<Clip> clips;
  for (std::size_t i = 0; i < count; ++i)
    clips.push_back(reader.read(entry(reading.json(), "animations", i), names[i]));
  return clips;
}

}  // namespace sunder::gltf
