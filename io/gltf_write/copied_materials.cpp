#include "io/gltf_write/copied_materials.h"

#include <array>
#include <set>
#include <string>
#include <utility>

namespace sunder::gltf {
namespace {

constexpr std::array<const char*, 4> kMaterialLists = {"materials", "textures", "samplers",
                                                       "images"};

/// The names of all extensions below a value.
void collect_extensions(const Json& value, std::set<std::string>& names) {
  if (value.is_object() && value.contains("extensions") && value["extensions"].is_object())
    for (const auto& [name, unused] : value["extensions"].items()) names.insert(name);
  if (value.is_structured())
    for (const Json& below : value) collect_extensions(below, names);
}

/// The names of a list that are in a set.
Json named(const Json& document, const char* list, const std::set<std::string>& names) {
  Json kept = Json::array();
  if (document.contains(list) && document[list].is_array())
    for (const Json& name : document[list])
      if (name.is_string() && names.contains(name.get<std::string>())) kept.push_back(name);
  return kept;
}

}  // namespace

void copy_materials(const SourceDocument& source, GlbDraft& draft) {
  GlbDraft from(source);
  from.embed_images();
  std::set<std::string> extensions;
  for (const char* const list : kMaterialLists) {
    if (!from.json.contains(list) || !from.json[list].is_array()) continue;
    collect_extensions(from.json[list], extensions);
    draft.json[list] = from.json[list];
  }
  if (draft.json.contains("images"))
    for (Json& image : draft.json["images"]) {
      if (!image.is_object() || !image.contains("bufferView")) continue;
      const std::span<const std::byte> bytes = from.bytes_of_view(image["bufferView"]);
      if (bytes.empty())
        image.erase("bufferView");  // the source names a view that it does not have
      else
        image["bufferView"] = draft.add_view(bytes, GlbDraft::ViewTarget::none);
    }
  for (const char* const list : {"extensionsUsed", "extensionsRequired"})
    if (Json names = named(from.json, list, extensions); !names.empty())
      draft.json[list] = std::move(names);
}

}  // namespace sunder::gltf
