#include "io/assimp/convert_animations.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace sunder::assimp_import {
namespace {

constexpr double kAssumedTicksPerSecond = 25.0;

/// Keyframes as in glTF.
struct Keys {
  std::vector<float> times;
  std::vector<float> values;
};

class ClipWriter {
 public:
  ClipWriter(const aiAnimation& source, std::string place, const SceneTree& tree, GlbBuilder& glb,
             Notes& notes)
      : place_(std::move(place)),
        tree_(tree),
        glb_(glb),
        notes_(notes),
        ticks_per_second_(source.mTicksPerSecond) {
    if (!(std::isfinite(ticks_per_second_) && ticks_per_second_ > 0.0)) {
      ticks_per_second_ = kAssumedTicksPerSecond;
      notes_.inform(place_, "no tick rate; 25 ticks per second are assumed");
    }
  }

  void add(const aiNodeAnim& channel) {
    const std::uint32_t node = tree_.find(channel.mNodeName);
    if (node == kNone) {
      notes_.dropped(StatusCode::not_found, place_, "channels of nodes that do not exist");
      return;
    }
    const auto vector_value = [](const aiVectorKey& key, std::vector<float>& values) {
      values.insert(values.end(), {key.mValue.x, key.mValue.y, key.mValue.z});
      return std::isfinite(key.mValue.x) && std::isfinite(key.mValue.y) &&
             std::isfinite(key.mValue.z);
    };
    const auto rotation_value = [](const aiQuatKey& key, std::vector<float>& values) {
      Quatd rotation(static_cast<double>(key.mValue.w), static_cast<double>(key.mValue.x),
                     static_cast<double>(key.mValue.y), static_cast<double>(key.mValue.z));
      const double length = rotation.norm();
      if (!std::isfinite(length) || length < 1e-6) return false;
      rotation.coeffs() /= length;
      // q and -q are the same rotation. The sign closer to the previous key makes every
      // interpolation take the shorter way.
      if (const std::size_t size = values.size(); size >= 4) {
        const float* before = values.data() + size - 4;
        double cosine = 0.0;
        for (int i = 0; i < 4; ++i) cosine += static_cast<double>(before[i]) * rotation.coeffs()[i];
        if (cosine < 0.0) rotation.coeffs() = -rotation.coeffs();
      }
      for (int i = 0; i < 4; ++i) values.push_back(static_cast<float>(rotation.coeffs()[i]));
      return true;
    };
    write(node, "translation", 3,
          collect(channel.mPositionKeys, channel.mNumPositionKeys, vector_value));
    write(node, "rotation", 4,
          collect(channel.mRotationKeys, channel.mNumRotationKeys, rotation_value));
    write(node, "scale", 3, collect(channel.mScalingKeys, channel.mNumScalingKeys, vector_value));
  }

  void add(const aiMeshMorphAnim& channel, std::span<const MorphedNode> morphed) {
    // In FBX the node's name, an asterisk and a number; in other formats the node's name.
    std::string name = to_string(channel.mName);
    const auto carries = [&](const MorphedNode& one) { return one.source_name == name; };
    if (std::none_of(morphed.begin(), morphed.end(), carries))
      name.resize(std::min(name.size(), name.rfind('*')));
    bool found = false;
    for (const MorphedNode& one : morphed) {
      if (!carries(one)) continue;
      found = true;
      const auto weights_value = [&](const aiMeshMorphKey& key, std::vector<float>& values) {
        const std::size_t start = values.size();
        values.resize(start + one.target_count, 0.0f);
        if (key.mValues == nullptr || key.mWeights == nullptr) return true;
        for (unsigned i = 0; i < key.mNumValuesAndWeights; ++i) {
          if (!std::isfinite(key.mWeights[i])) return false;
          if (key.mValues[i] < one.target_count)
            values[start + key.mValues[i]] = static_cast<float>(key.mWeights[i]);
        }
        return true;
      };
      write(one.node, "weights", 1, collect(channel.mKeys, channel.mNumKeys, weights_value));
    }
    if (!found)
      notes_.dropped(StatusCode::not_found, place_, "morph channels of meshes that do not exist");
  }

  /// The animation; empty if it has no channel.
  [[nodiscard]] Json take() { return std::move(json_); }

 private:
  /// `append_value` appends a key's floats and returns whether they are usable.
  template <class Key, class AppendValue>
  Keys collect(const Key* keys, unsigned count, const AppendValue& append_value) {
    Keys result;
    std::uint32_t out_of_order = 0, before_zero = 0, not_finite = 0;
    for (unsigned i = 0; keys != nullptr && i < count; ++i) {
      const double seconds = keys[i].mTime / ticks_per_second_;
      const auto time = static_cast<float>(seconds);
      const std::size_t size = result.values.size();
      if (!std::isfinite(time)) {
        ++not_finite;
      } else if (seconds < 0.0) {
        ++before_zero;
      } else if (!result.times.empty() && time <= result.times.back()) {
        if (time < result.times.back() || !repeats_last(keys[i], append_value, result.values))
          ++out_of_order;
      } else if (!append_value(keys[i], result.values)) {
        ++not_finite;
        result.values.resize(size);
      } else {
        result.times.push_back(time);
      }
    }
    notes_.dropped(StatusCode::malformed_file, place_, "keys not later than the one before",
                   out_of_order);
    notes_.dropped(StatusCode::malformed_file, place_, "keys before time zero", before_zero);
    notes_.dropped(StatusCode::non_finite_value, place_, "keys that are not finite", not_finite);
    return result;
  }

  /// Whether a key has about the values that `values` ends with. Some exporters write keys twice, a
  /// few nanoseconds apart.
  template <class Key, class AppendValue>
  static bool repeats_last(const Key& key, const AppendValue& append_value,
                           std::vector<float>& values) {
    const std::size_t size = values.size();
    const bool is_usable = append_value(key, values);
    const auto own = static_cast<std::ptrdiff_t>(values.size() - size);
    const bool repeats =
        is_usable && values.size() <= 2 * size &&
        std::equal(values.end() - own, values.end(), values.end() - 2 * own, [](float a, float b) {
          return std::abs(a - b) <= 1e-4f * std::max(1.0f, std::abs(b));
        });
    values.resize(size);
    return repeats;
  }

  void write(std::uint32_t node, const char* path, int components, const Keys& keys) {
    if (keys.times.empty()) return;
    if (!driven_.emplace(node, path).second) {
      notes_.dropped(StatusCode::malformed_file, place_,
                     "channels with the same target as an earlier channel");
      return;
    }
    const std::uint32_t input = input_of(keys.times);
    const std::uint32_t output = glb_.add_floats(keys.values, components, GlbBuilder::Use::plain);
    json_["samplers"].push_back(
        {{"input", input}, {"interpolation", "LINEAR"}, {"output", output}});
    json_["channels"].push_back(
        {{"sampler", json_["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  }

  /// Channels often have equal times; they then share one accessor.
  std::uint32_t input_of(const std::vector<float>& times) {
    const auto known = std::find_if(inputs_.rbegin(), inputs_.rend(),
                                    [&](const auto& input) { return input.first == times; });
    if (known != inputs_.rend()) return known->second;
    const std::uint32_t accessor = glb_.add_floats(times, 1, GlbBuilder::Use::plain, true);
    if (inputs_.size() < 16)
      inputs_.emplace_back(times, accessor);  // A bound on the search for equal times.
    return accessor;
  }

  std::string place_;
  const SceneTree& tree_;
  GlbBuilder& glb_;
  Notes& notes_;
  double ticks_per_second_;
  Json json_ = Json::object();
  std::set<std::pair<std::uint32_t, std::string>> driven_;
  std::vector<std::pair<std::vector<float>, std::uint32_t>> inputs_;
};

}  // namespace

void convert_animations(const aiScene& scene, const SceneTree& tree,
                        std::span<const MorphedNode> morphed, GlbBuilder& glb, Notes& notes) {
  for (unsigned i = 0; i < scene.mNumAnimations; ++i) {
    const aiAnimation& source = *scene.mAnimations[i];
    const std::string name = valid_utf8(to_string(source.mName));
    const std::string place = "clip " + std::to_string(i) + " '" + name + "'";
    ClipWriter clip(source, place, tree, glb, notes);
    for (unsigned k = 0; k < source.mNumChannels; ++k)
      if (source.mChannels[k] != nullptr) clip.add(*source.mChannels[k]);
    for (unsigned k = 0; k < source.mNumMorphMeshChannels; ++k)
      if (source.mMorphMeshChannels[k] != nullptr) clip.add(*source.mMorphMeshChannels[k], morphed);
    if (source.mNumMeshChannels > 0)
      notes.dropped(StatusCode::unsupported_feature, place, "mesh-swapping channels",
                    source.mNumMeshChannels);
    Json json = clip.take();
    if (json.empty()) {
      notes.dropped(StatusCode::empty_input, place, "animations that drive nothing");
      continue;
    }
    if (!name.empty()) json["name"] = name;
    glb.append("animations", std::move(json));
  }
}

}  // namespace sunder::assimp_import
