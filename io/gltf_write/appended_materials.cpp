#include "io/gltf_write/appended_materials.h"

#include <algorithm>
#include <string>
#include <utility>

#include "io/gltf/cursor.h"
#include "io/gltf/image_header.h"
#include "io/gltf/refusal.h"
#include "io/gltf_write/lists.h"

namespace sunder::gltf {
namespace {

constexpr const char* kTransform = "KHR_texture_transform";

Json& object_at(Json& parent, const char* name) {
  Json& object = parent[name];
  if (!object.is_object()) object = Json::object();
  return object;
}

void add_name(Json& names, const char* name) {
  if (std::ranges::find(names, Json(name)) == names.end()) names.push_back(name);
}

/// Makes a texture reference show another texture.
/// @param reference  that of the source; null: it has none.
void place_texture(const PaintedMaterial& painted, std::size_t texture, Json& reference,
                   Json& document) {
  if (!reference.is_object()) reference = Json::object();
  reference["index"] = texture;
  if (!painted.placement) return;
  reference["texCoord"] = painted.uv_set;
  if (const auto extensions = reference.find("extensions"); extensions != reference.end()) {
    if (extensions->is_object()) extensions->erase(kTransform);
    if (!extensions->is_object() || extensions->empty()) reference.erase("extensions");
  }
  const PaintedMaterial::Placement& at = *painted.placement;
  object_at(object_at(reference, "extensions"), kTransform) = {
      {"offset", numbers_of({at.offset.data(), 2})}, {"scale", numbers_of({at.scale.data(), 2})}};
  add_name(list_of(document, "extensionsUsed"), kTransform);
}

/// The texture of the painted image, with the sampler of the one that it stands for.
std::size_t add_texture(const PaintedMaterial& painted, const Json& replaced, GlbDraft& draft) {
  const std::uint32_t view = draft.add_view(painted.image, GlbDraft::ViewTarget::none);
  const Index image =
      append(draft.json, "images", {{"bufferView", view}, {"mimeType", "image/png"}});
  Json texture = {{"source", image}};
  const Json number = replaced.is_object() ? replaced.value("index", Json()) : Json();
  if (number.is_number_unsigned() && number < count_of(draft.json, "textures")) {
    const Json& of_source = draft.json["textures"][number.get<std::size_t>()];
    if (of_source.is_object() && of_source.contains("sampler"))
      texture["sampler"] = of_source["sampler"];
  }
  return append(draft.json, "textures", std::move(texture));
}

void append_painted(const PaintedMaterial& painted, std::size_t of_source, GlbDraft& draft) {
  Json material = Json::object();
  if (painted.source < of_source) material = draft.json["materials"][painted.source];
  if (!material.is_object()) material = Json::object();
  Json& surface = object_at(material, "pbrMetallicRoughness");
  Json& reference = surface["baseColorTexture"];
  const std::size_t texture = add_texture(painted, reference, draft);
  place_texture(painted, texture, reference, draft.json);
  Json& factor = surface["baseColorFactor"];
  const bool has_factor = factor.is_array() && factor.size() == 4;
  for (std::size_t i = 0; has_factor && i < 3; ++i) factor[i] = 1.0;
  if (!has_factor) surface.erase("baseColorFactor");
  const Json name = material.value("name", Json());
  material["name"] = (name.is_string() ? name.get<std::string>() + " " : std::string()) + "blood";
  append(draft.json, "materials", std::move(material));
}

}  // namespace

void check_painted(const PaintedMaterial& painted, Index index) {
  const char* const type = image_type(painted.image);
  if (type == nullptr || std::string(type) != "image/png")
    refuse(StatusCode::invalid_argument, index, "save_glb: painted material %u: not a PNG", index);
  if (painted.placement &&
      !(painted.placement->offset.allFinite() && painted.placement->scale.allFinite()))
    refuse(StatusCode::invalid_argument, index,
           "save_glb: painted material %u: its placement is not finite", index);
}

void append_materials(const Character& character, const SaveOptions& options, GlbDraft& draft) {
  const std::size_t of_source = count_of(draft.json, "materials");
  const auto is_appended = [&](const Submesh& submesh) {
    return submesh.material != kNone && submesh.material >= of_source;
  };
  const bool is_any_named = std::ranges::any_of(character.meshes, [&](const Mesh& mesh) {
    return std::ranges::any_of(mesh.submeshes, is_appended);
  });
  if (!is_any_named) return;
  for (const AppendedMaterial& of : options.materials) {
    Json material = {{"pbrMetallicRoughness",
                      {{"baseColorFactor", numbers_of({of.base_colour.data(), 4})},
                       {"metallicFactor", static_cast<double>(of.metallic)},
                       {"roughnessFactor", static_cast<double>(of.roughness)}}}};
    if (!of.name.empty()) material["name"] = of.name;
    if (of.double_sided) material["doubleSided"] = true;
    if (of.base_colour.w() < 1) material["alphaMode"] = "BLEND";
    append(draft.json, "materials", std::move(material));
  }
  for (const PaintedMaterial& painted : options.painted) append_painted(painted, of_source, draft);
}

}  // namespace sunder::gltf
