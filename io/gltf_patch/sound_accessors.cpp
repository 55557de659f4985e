#include "io/gltf_patch/sound_accessors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/gltf/refusal.h"
#include "io/gltf_patch/accessor_layout.h"

namespace sunder::gltf {
namespace {

/// A limit must not look like a fault of the accessor, which would be repaired without a word.
void check_limit(const Refusal& refusal, const Accessor& accessor) {
  if (refusal.status.code() == StatusCode::limit_exceeded)
    refuse(StatusCode::limit_exceeded, accessor.index,
           "/accessors/%u: the document cannot be checked for saving, because its accessors lie on "
           "the same bytes too often",
           accessor.index);
}

/// The numbers of a bound as JSON.
Json bound(const std::vector<double>& values, bool is_integer) {
  Json list = Json::array();
  for (const double value : values) {
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
  const auto [known, is_new] = opened_.try_emplace(index.get<std::uint64_t>());
  if (is_new) known->second = open_new(index);
  return known->second;
}

std::optional<Accessor> SoundAccessors::open_new(const Json& index) {
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
  const std::uint64_t size = component_bytes(accessor);
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
  if (!fits(indices, component_bytes(indices)) ||
      !fits((*sparse)["values"], component_bytes(accessor)))
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
  } catch (const Refusal& refusal) {
    check_limit(refusal, accessor);
    return {};
  }
}

std::optional<std::vector<std::uint32_t>> SoundAccessors::integers(const Accessor& accessor) {
  try {
    return reader_.read_unsigned(accessor);
  } catch (const Refusal& refusal) {
    check_limit(refusal, accessor);
    return {};
  }
}

const SoundAccessors::Survey& SoundAccessors::survey(const Accessor& accessor) {
  const auto [known, is_new] = surveys_.try_emplace(accessor.index);
  Survey& found = known->second;
  if (!is_new) return found;
  Accessor stored = accessor;
  stored.normalized = false;
  const std::size_t components = stored.components;
  const auto visit = [&](const auto& values) {
    found.is_finite = true;
    for (std::size_t c = 0; c < components; ++c) {
      auto least = values[c], greatest = values[c];
      for (std::size_t i = c; i < values.size(); i += components) {
        least = std::min(least, values[i]);
        greatest = std::max(greatest, values[i]);
      }
      found.least.push_back(static_cast<double>(least));
      found.greatest.push_back(static_cast<double>(greatest));
    }
  };
  if (stored.data == nullptr && stored.sparse_count == 0) {
    visit(std::vector<float>(components, 0.0f));
  } else if (stored.component_type == ComponentType::u32) {
    if (const auto values = integers(stored)) visit(*values);
  } else {
    if (const auto values = floats(stored)) visit(*values);
  }
  return found;
}

bool SoundAccessors::is_finite(const Accessor& accessor) { return survey(accessor).is_finite; }

std::optional<double> SoundAccessors::greatest(const Accessor& accessor) {
  const Survey& found = survey(accessor);
  if (!found.is_finite) return {};
  return *std::max_element(found.greatest.begin(), found.greatest.end());
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
  const Survey& found = survey(*accessor);
  for (const auto& [name, values] :
       {std::pair{"min", &found.least}, std::pair{"max", &found.greatest}}) {
    if (!required && !json.contains(name)) continue;
    if (!found.is_finite) {
      json.erase(name);
      continue;
    }
    Json right = bound(*values, accessor->is_integer());
    if (!is_same_bound(json, name, right)) json[name] = std::move(right);
  }
}

}  // namespace sunder::gltf
