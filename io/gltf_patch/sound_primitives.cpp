#include "io/gltf_patch/sound_primitives.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "io/gltf/unit_tolerance.h"

namespace sunder::gltf {
namespace {

constexpr double kSumTolerance = 2e-7;  // that of the Khronos validator, per influence

/// "TEXCOORD" and 1 of "TEXCOORD_1"; without a number: kNone.
std::pair<std::string, std::uint32_t> split_semantic(const std::string& semantic) {
  const std::size_t line = semantic.find('_');
  if (line == std::string::npos || line == 0) return {semantic, kNone};
  const std::string digits = semantic.substr(line + 1);
  const bool is_number = !digits.empty() && digits.size() < 4 &&
                         digits.find_first_not_of("0123456789") == std::string::npos &&
                         (digits.size() == 1 || digits[0] != '0');
  if (!is_number) return {semantic, kNone};
  return {semantic.substr(0, line), static_cast<std::uint32_t>(std::stoul(digits))};
}

bool is_byte_or_short(const Accessor& accessor) {
  return accessor.is_integer() && accessor.component_type != ComponentType::u32;
}
bool is_unsigned(const Accessor& accessor) {
  return accessor.component_type == ComponentType::u8 ||
         accessor.component_type == ComponentType::u16;
}
bool is_signed(const Accessor& accessor) {
  return accessor.component_type == ComponentType::i8 ||
         accessor.component_type == ComponentType::i16;
}

/// Names with numbers must count from 0 without a gap.
bool are_sets_continuous(const Json& attributes) {
  std::map<std::string, std::set<std::uint32_t>> sets;
  for (const auto& item : attributes.items()) {
    const auto [name, number] = split_semantic(item.key());
    if (number != kNone) sets[name].insert(number);
  }
  for (const auto& [name, numbers] : sets)
    if (*numbers.rbegin() + 1 != numbers.size()) return false;
  return sets["JOINTS"].size() == sets["WEIGHTS"].size();
}

bool are_unit(const std::vector<float>& values, std::size_t components) {
  for (std::size_t i = 0; i + components <= values.size(); i += components) {
    double squared = 0;
    for (std::size_t c = 0; c < 3; ++c)
      squared += static_cast<double>(values[i + c]) * static_cast<double>(values[i + c]);
    if (std::abs(std::sqrt(squared) - 1.0) > kUnitTolerance) return false;
    if (components == 4 && std::abs(values[i + 3]) != 1.0f) return false;
  }
  return true;
}

bool are_shares(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](float one) { return one >= 0.0f && one <= 1.0f; });
}

}  // namespace

SoundPrimitives::SoundPrimitives(const Json& json, SoundAccessors& accessors)
    : accessors_(accessors) {
  if (const auto used = json.find("extensionsUsed"); used != json.end())
    is_quantized_ = std::find(used->begin(), used->end(), "KHR_mesh_quantization") != used->end();
}

std::uint32_t SoundPrimitives::vertex_count(const Json& primitive) {
  const Json& attributes = primitive["attributes"];
  const auto position = attributes.find("POSITION");
  if (position == attributes.end()) return 0;
  const auto accessor = accessors_.open(*position);
  return accessor ? accessor->count : 0;
}

bool SoundPrimitives::is_sound(const Json& primitive, std::uint32_t joint_count) {
  if (!primitive.is_object()) return false;
  const Json& attributes = primitive["attributes"];
  const std::uint32_t count = vertex_count(primitive);
  if (count == 0 || !are_sets_continuous(attributes)) return false;
  for (const auto& item : attributes.items()) {
    const auto accessor = accessors_.open(item.value());
    if (!accessor || accessor->count != count || !is_attribute_sound(item.key(), *accessor))
      return false;
  }
  return are_influences_sound(attributes, joint_count) && are_indices_sound(primitive, count) &&
         are_targets_sound(primitive, count);
}

bool SoundPrimitives::is_format_allowed(const std::string& semantic,
                                        const Accessor& accessor) const {
  const auto [name, number] = split_semantic(semantic);
  const std::string_view type = accessors_.type(accessor);
  const bool is_float = !accessor.is_integer();
  const bool is_share = is_float || (is_unsigned(accessor) && accessor.normalized);
  if (semantic.front() == '_') return accessor.component_type != ComponentType::u32;
  if (semantic == "POSITION")
    return type == "VEC3" && (is_float || (is_quantized_ && is_byte_or_short(accessor)));
  if (semantic == "NORMAL" || semantic == "TANGENT")
    return type == (semantic == "NORMAL" ? "VEC3" : "VEC4") &&
           (is_float || (is_quantized_ && is_signed(accessor) && accessor.normalized));
  if (number == kNone) return false;
  if (name == "TEXCOORD")
    return type == "VEC2" && (is_share || (is_quantized_ && is_byte_or_short(accessor)));
  if (name == "COLOR") return (type == "VEC3" || type == "VEC4") && is_share;
  if (name == "JOINTS") return type == "VEC4" && is_unsigned(accessor) && !accessor.normalized;
  return name == "WEIGHTS" && type == "VEC4" && is_share;
}

bool SoundPrimitives::is_attribute_sound(const std::string& semantic, const Accessor& accessor) {
  if (!is_format_allowed(semantic, accessor) || !accessors_.is_aligned_for_vertices(accessor))
    return false;
  using Rule = SoundAccessors::Rule;
  using Numbers = std::vector<float>;
  bool is_sound = true;
  if (semantic == "NORMAL")
    is_sound = accessors_.follows(Rule::normals, accessor,
                                  [](const Numbers& values) { return are_unit(values, 3); });
  else if (semantic == "TANGENT")
    is_sound = accessors_.follows(Rule::tangents, accessor,
                                  [](const Numbers& values) { return are_unit(values, 4); });
  else if (!accessor.is_integer() && semantic.starts_with("COLOR_"))
    is_sound = accessors_.follows(Rule::shares, accessor, are_shares);
  else if (!accessor.is_integer())
    is_sound = accessors_.is_finite(accessor);
  if (!is_sound) return false;
  accessors_.correct_bounds(accessor.index, semantic == "POSITION");
  return true;
}

bool SoundPrimitives::are_influences_sound(const Json& attributes, std::uint32_t joint_count) {
  std::vector<Accessor> sets;  // Joints and weights in turns.
  std::vector<std::uint32_t> key;
  for (std::size_t set = 0; attributes.contains("JOINTS_" + std::to_string(set)); ++set)
    for (const char* const name : {"JOINTS_", "WEIGHTS_"}) {
      sets.push_back(*accessors_.open(attributes[name + std::to_string(set)]));
      key.push_back(sets.back().index);
    }
  for (std::size_t i = 0; i < sets.size(); i += 2) {
    const auto greatest = accessors_.greatest(sets[i]);
    if (!greatest || *greatest >= joint_count) return false;
  }
  const auto [known, is_new] = influences_.try_emplace(std::move(key), true);
  if (is_new) known->second = are_weights_sound(sets);
  return known->second;
}

bool SoundPrimitives::are_weights_sound(const std::vector<Accessor>& sets) {
  std::vector<std::vector<std::uint32_t>> joints;
  std::vector<std::vector<float>> weights;
  for (std::size_t i = 0; i < sets.size(); i += 2) {
    auto numbers = accessors_.integers(sets[i]);
    auto shares = accessors_.floats(sets[i + 1]);
    if (!numbers || !shares) return false;
    joints.push_back(std::move(*numbers));
    weights.push_back(std::move(*shares));
  }
  if (joints.empty()) return true;
  std::vector<std::uint32_t> used;
  for (std::size_t first = 0; first < joints[0].size(); first += 4) {
    used.clear();
    double sum = 0;
    for (std::size_t set = 0; set < joints.size(); ++set)
      for (std::size_t i = first; i < first + 4; ++i) {
        if (weights[set][i] < 0.0f) return false;
        if (weights[set][i] == 0.0f) continue;
        used.push_back(joints[set][i]);
        sum += static_cast<double>(weights[set][i]);
      }
    std::sort(used.begin(), used.end());
    if (std::adjacent_find(used.begin(), used.end()) != used.end()) return false;
    // Integer weights sum to one exactly but for the conversion to floats.
    if (std::abs(sum - 1.0) > kSumTolerance * static_cast<double>(used.size()) + 1e-8) return false;
  }
  return true;
}

bool SoundPrimitives::are_indices_sound(const Json& primitive, std::uint32_t vertex_count) {
  const auto at = primitive.find("indices");
  if (at == primitive.end()) return true;
  const auto accessor = accessors_.open(*at);
  if (!accessor || accessors_.type(*accessor) != "SCALAR" || accessor->normalized ||
      accessors_.has_stride(*accessor))
    return false;
  if (!is_unsigned(*accessor) && accessor->component_type != ComponentType::u32) return false;
  const auto greatest = accessors_.greatest(*accessor);
  // The largest number of a type restarts the primitive.
  std::uint32_t restart = 0xFF;
  if (accessor->component_type == ComponentType::u16) restart = 0xFFFF;
  if (accessor->component_type == ComponentType::u32) restart = kNone;
  if (!greatest || *greatest >= vertex_count || *greatest == restart) return false;
  accessors_.correct_bounds(accessor->index, false);
  return true;
}

bool SoundPrimitives::is_delta_allowed(const std::string& semantic,
                                       const Accessor& accessor) const {
  const std::string_view type = accessors_.type(accessor);
  if (semantic == "POSITION" || semantic == "NORMAL" || semantic == "TANGENT")
    return type == "VEC3" && (!accessor.is_integer() || (is_quantized_ && is_signed(accessor)));
  const auto [name, number] = split_semantic(semantic);
  if (semantic.front() == '_') return accessor.component_type != ComponentType::u32;
  if (number == kNone) return false;
  const bool is_share =
      !accessor.is_integer() || (is_byte_or_short(accessor) && accessor.normalized);
  if (name == "TEXCOORD") return type == "VEC2" && is_share;
  return name == "COLOR" && (type == "VEC3" || type == "VEC4") && is_share;
}

bool SoundPrimitives::are_targets_sound(const Json& primitive, std::uint32_t vertex_count) {
  const auto targets = primitive.find("targets");
  if (targets == primitive.end()) return true;
  for (const Json& target : *targets) {
    if (target.empty()) return false;
    for (const auto& item : target.items()) {
      if (!primitive["attributes"].contains(item.key())) return false;
      const auto accessor = accessors_.open(item.value());
      if (!accessor || accessor->count != vertex_count ||
          !is_delta_allowed(item.key(), *accessor) ||
          !accessors_.is_aligned_for_vertices(*accessor))
        return false;
      if (!accessor->is_integer() && !accessors_.is_finite(*accessor)) return false;
      accessors_.correct_bounds(accessor->index, item.key() == "POSITION");
    }
  }
  return true;
}

}  // namespace sunder::gltf
