#include "io/gltf_patch/sound_accessors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

std::uint64_t whole_or(const Json& object, const char* name, std::uint64_t otherwise) {
  const auto found = object.find(name);
  return found == object.end() ? otherwise : found->get<std::uint64_t>();
}

std::uint64_t component_bytes(std::uint64_t type) {
  return type <= 5121 ? 1 : type <= 5123 ? 2 : 4;
}

/// The numbers of a bound as JSON; null if a bound is not finite.
Json bound(const std::vector<double>& values, bool is_integer) {
  Json list = Json::array();
  for (const double value : values) {
    if (!std::isfinite(value)) return nullptr;
    if (is_integer)
      list.push_back(static_cast<std::int64_t>(value));
    else
      list.push_back(value);
  }
  return list;
}

bool is_same_bound(const Json& object, const char* name, const Json& right) {
  const auto found = object.find(name);
  if (found == object.end() || found->size() != right.size()) return false;
  for (std::size_t i = 0; i < right.size(); ++i) {
    const Json &a = (*found)[i], &b = right[i];
    // Bounds of floats may be written with any number of digits.
    const bool is_equal = b.is_number_integer() ? a.is_number_integer() && a == b
                                                : static_cast<float>(a.get<double>()) ==
                                                      static_cast<float>(b.get<double>());
    if (!is_equal) return false;
  }
  return true;
}

}  // namespace

SoundAccessors::SoundAccessors(SourceDocument& document) : document_(document), reader_(document) {}

std::optional<Accessor> SoundAccessors::open(const Json& index) {
  try {
    const Accessor accessor = reader_.open(Cursor(index, ""));
    const Json& json = document_.json["accessors"][accessor.index];
    if (!is_aligned(json) || !is_sparse_sound(json, accessor)) return {};
    // Integer matrices have padded columns, which the reader does not know.
    if (accessor.is_matrix && accessor.is_integer()) return {};
    if (accessor.normalized &&
        (!accessor.is_integer() || accessor.component_type == ComponentType::u32))
      return {};
    return accessor;
  } catch (const Refusal&) {
    return {};
  }
}

bool SoundAccessors::is_aligned(const Json& accessor) const {
  const std::uint64_t size = component_bytes(accessor["componentType"].get<std::uint64_t>());
  const auto view_at = accessor.find("bufferView");
  if (view_at == accessor.end()) return !accessor.contains("byteOffset");
  const Json& view = document_.json["bufferViews"][view_at->get<std::size_t>()];
  const std::uint64_t offset = whole_or(accessor, "byteOffset", 0);
  const bool is_matrix = accessor["type"].get_ref<const std::string&>().front() == 'M';
  return offset % size == 0 && (whole_or(view, "byteOffset", 0) + offset) % size == 0 &&
         whole_or(view, "byteStride", 0) % size == 0 && (!is_matrix || offset % 4 == 0);
}

bool SoundAccessors::is_sparse_sound(const Json& accessor, const Accessor& opened) {
  const auto sparse = accessor.find("sparse");
  if (sparse == accessor.end()) return true;
  const auto fits = [&](const Json& part, std::uint64_t size) {
    const Json& view = document_.json["bufferViews"][part["bufferView"].get<std::size_t>()];
    const std::uint64_t offset = whole_or(part, "byteOffset", 0);
    return !view.contains("byteStride") && offset % size == 0 &&
           (whole_or(view, "byteOffset", 0) + offset) % size == 0;
  };
  const Json& indices = (*sparse)["indices"];
  if (!fits(indices, component_bytes(indices["componentType"].get<std::uint64_t>())) ||
      !fits((*sparse)["values"], component_bytes(accessor["componentType"].get<std::uint64_t>())))
    return false;
  std::uint64_t next = 0;
  for (std::uint32_t i = 0; i < opened.sparse_count; ++i) {
    const std::uint32_t index = reader_.sparse_index(opened, i);
    if (index < next || index >= opened.count) return false;
    next = std::uint64_t{index} + 1;
  }
  return true;
}

std::optional<std::vector<float>> SoundAccessors::floats(const Accessor& accessor) {
  try {
    std::vector<float> values = reader_.read_floats(accessor);
    if (!std::all_of(values.begin(), values.end(), [](float one) { return std::isfinite(one); }))
      return {};
    return values;
  } catch (const Refusal&) {
    return {};
  }
}

std::optional<std::vector<std::uint32_t>> SoundAccessors::integers(const Accessor& accessor) {
  try {
    return reader_.read_unsigned(accessor);
  } catch (const Refusal&) {
    return {};
  }
}

bool SoundAccessors::has_stride(const Accessor& accessor) const {
  const Json& json = document_.json["accessors"][accessor.index];
  const auto view = json.find("bufferView");
  return view != json.end() &&
         document_.json["bufferViews"][view->get<std::size_t>()].contains("byteStride");
}

bool SoundAccessors::is_aligned_for_vertices(const Accessor& accessor) const {
  const Json& json = document_.json["accessors"][accessor.index];
  const auto view_at = json.find("bufferView");
  if (view_at == json.end()) return true;
  const Json& view = document_.json["bufferViews"][view_at->get<std::size_t>()];
  const std::uint64_t offset = whole_or(json, "byteOffset", 0);
  return offset % 4 == 0 && (whole_or(view, "byteOffset", 0) + offset) % 4 == 0 &&
         accessor.stride % 4 == 0;
}

std::string_view SoundAccessors::type(const Accessor& accessor) const {
  return document_.json["accessors"][accessor.index]["type"].get_ref<const std::string&>();
}

void SoundAccessors::correct_bounds(std::uint32_t index, bool required) {
  Json& json = document_.json["accessors"][index];
  if (!required && !json.contains("min") && !json.contains("max")) return;
  const auto accessor = open(Json(index));
  if (!accessor) return;
  std::vector<double> least(accessor->components, HUGE_VAL), greatest(least.size(), -HUGE_VAL);
  const auto visit = [&](const auto& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double value = static_cast<double>(values[i]);
      double &low = least[i % least.size()], &high = greatest[i % least.size()];
      low = std::min(low, value);
      high = std::max(high, value);
    }
  };
  // Bounds are those of the stored numbers, not of the normalised ones.
  Accessor stored = *accessor;
  stored.normalized = false;
  if (stored.component_type == ComponentType::u32) {
    if (const auto values = integers(stored)) visit(*values);
  } else {
    if (const auto values = floats(stored)) visit(*values);
  }
  const bool is_integer = stored.is_integer();
  for (const auto& [name, values] : {std::pair{"min", &least}, std::pair{"max", &greatest}}) {
    if (!required && !json.contains(name)) continue;
    Json right = bound(*values, is_integer);
    if (right.is_null())
      json.erase(name);
    else if (!is_same_bound(json, name, right))
      json[name] = std::move(right);
  }
}

}  // namespace sunder::gltf
