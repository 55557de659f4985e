#include "io/gltf/accessor_bounds.h"

#include <algorithm>
#include <vector>

#include "io/gltf/accessors.h"

namespace sunder::gltf {
namespace {

/// Least and largest value per component, as they are stored.
void write_bounds(AccessorReader& reader, Accessor accessor, Json& json) {
  accessor.normalized = false;  // Bounds are of the stored numbers.
  const std::vector<float> values = reader.read_floats(accessor);
  for (std::size_t c = 0; c < accessor.components; ++c) {
    float least = values[c], largest = values[c];
    for (std::size_t i = c; i < values.size(); i += accessor.components) {
      least = std::min(least, values[i]);
      largest = std::max(largest, values[i]);
    }
    json["min"][c] = least;
    json["max"][c] = largest;
  }
}

}  // namespace

void correct_bounds(SourceDocument& document, std::span<const std::uint32_t> views) {
  AccessorReader reader(document);
  for (std::uint32_t i = 0; i < count_of(document.json, "accessors"); ++i) {
    Json& json = document.json["accessors"][i];
    if (!json.is_object() || !json.contains("min") || !json.contains("max")) continue;
    const auto view = json.find("bufferView");
    if (view == json.end() || !view->is_number_unsigned() ||
        std::find(views.begin(), views.end(), view->get<std::uint64_t>()) == views.end())
      continue;
    const Json index = i;
    const Accessor accessor = reader.open(Cursor(index, "/accessors"));
    if (accessor.component_type == ComponentType::u32) continue;
    json["min"] = json["max"] = Json::array();
    write_bounds(reader, accessor, json);
  }
}

}  // namespace sunder::gltf
