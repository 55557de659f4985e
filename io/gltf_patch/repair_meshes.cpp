#include "io/gltf_patch/repair_meshes.h"

#include <sunder/core/index.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "io/gltf/glb.h"

namespace sunder::gltf {
namespace {

/// A pixel whose normal is that of the surface.
constexpr const char* kFlatNormals =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mNo"
    "aPgPAAODAgA+WCglAAAAAElFTkSuQmCC";

class MeshRepair {
 public:
  explicit MeshRepair(Json& document) : document_(document) {}

  void run() {
    const std::size_t count = count_of(document_, "meshes");
    for (std::size_t i = 0; i < count; ++i) {
      remove_null_primitives(i);
      unify_targets(i);
      for (const Json& primitive : mesh_at(i)["primitives"]) add_normal_map(primitive);
      add_texture_coordinates(mesh_at(i)["primitives"]);
    }
    remove_from_nodes();
  }

 private:
  Json& mesh_at(std::size_t index) { return document_["meshes"][index]; }

  /// Zeros, which take no space in the file; primitives of the same vertices share them.
  std::size_t add_zeros(const Json& primitive, const char* type, std::size_t components) {
    const Json& attributes = primitive["attributes"];
    const std::size_t count =
        attributes.contains("POSITION")
            ? document_["accessors"][attributes["POSITION"].get<std::size_t>()]["count"]
                  .get<std::size_t>()
            : 1;
    const auto [known, is_new] = zeros_.try_emplace({count, components}, 0);
    if (!is_new) return known->second;
    Json accessor = {{"componentType", 5126}, {"count", count}, {"type", type}};
    for (const char* const bound : {"min", "max"})
      if (components == 3) accessor[bound] = {0.0, 0.0, 0.0};
    Json& accessors = list_of(document_, "accessors");
    accessors.push_back(std::move(accessor));
    return known->second = accessors.size() - 1;
  }

  void remove_null_primitives(std::size_t index) {
    Json kept = Json::array();
    if (mesh_at(index).contains("primitives"))
      for (Json& primitive : mesh_at(index)["primitives"])
        if (!primitive.is_null()) kept.push_back(std::move(primitive));
    if (kept.empty()) {
      const Json nothing = {{"attributes", Json::object()}};
      kept.push_back({{"attributes", {{"POSITION", add_zeros(nothing, "VEC3", 3)}}}, {"mode", 0}});
      without_triangles_.insert(index);
      for (const char* const key : {"weights", "extensions"}) mesh_at(index).erase(key);
    }
    mesh_at(index)["primitives"] = std::move(kept);
  }

  void remove_from_nodes() {
    if (without_triangles_.empty() || !document_.contains("nodes")) return;
    for (Json& node : document_["nodes"])
      if (node.contains("mesh") && without_triangles_.contains(node["mesh"].get<std::size_t>()))
        for (const char* const key : {"mesh", "skin", "weights"}) node.erase(key);
  }

  static std::size_t target_count(const Json& primitive) {
    const auto targets = primitive.find("targets");
    return targets == primitive.end() ? 0 : targets->size();
  }

  void unify_targets(std::size_t index) {
    Json& mesh = mesh_at(index);
    std::size_t count = 0;
    for (const Json& primitive : mesh["primitives"])
      count = std::max(count, target_count(primitive));
    for (Json& primitive : mesh["primitives"]) {
      if (target_count(primitive) == count) continue;
      const std::size_t zeros = add_zeros(primitive, "VEC3", 3);
      Json& targets = list_of(primitive, "targets");
      while (targets.size() < count) targets.push_back({{"POSITION", zeros}});
    }
    if (!mesh.contains("weights") || mesh["weights"].size() == count) return;
    Json weights = Json::array();
    for (std::size_t i = 0; i < count; ++i)
      weights.push_back(i < mesh["weights"].size() ? mesh["weights"][i] : Json(0.0));
    if (weights.empty())
      mesh.erase("weights");
    else
      mesh["weights"] = std::move(weights);
  }

  // ---- Texture coordinates

  /// The largest set to which a texture of the material refers, plus one.
  static std::size_t needed_sets(const Json& value) {
    if (!value.is_structured()) return 0;
    std::size_t needed = 0;
    for (const auto& item : value.items()) {
      if (item.key() == "extras") continue;
      needed = std::max(needed, needed_sets(item.value()));
    }
    // A texture is an object with an index.
    if (!value.is_object() || !value.contains("index") || !value["index"].is_number_unsigned())
      return needed;
    std::size_t set = value.contains("texCoord") ? value["texCoord"].get<std::size_t>() : 0;
    if (value.contains("extensions") && value["extensions"].contains("KHR_texture_transform")) {
      const Json& transform = value["extensions"]["KHR_texture_transform"];
      if (transform.contains("texCoord")) set = transform["texCoord"].get<std::size_t>();
    }
    return std::max(needed, set + 1);
  }

  /// A set that the file lacks is zero in every viewer. Primitives of the same vertices get the
  /// same sets, so that they keep sharing them.
  void add_texture_coordinates(Json& primitives) {
    std::map<std::string, std::size_t> needed_by_attributes;
    for (const Json& primitive : primitives) {
      if (!primitive.contains("material")) continue;
      const Json& material = document_["materials"][primitive["material"].get<std::size_t>()];
      std::size_t& needed = needed_by_attributes[primitive["attributes"].dump()];
      needed = std::max(needed, needed_sets(material));
    }
    for (Json& primitive : primitives) {
      const std::size_t needed = needed_by_attributes[primitive["attributes"].dump()];
      for (std::size_t set = 0; set < needed; ++set) {
        const std::string semantic = "TEXCOORD_" + std::to_string(set);
        if (primitive["attributes"].contains(semantic)) continue;
        const std::size_t zeros = add_zeros(primitive, "VEC2", 2);
        primitive["attributes"][semantic] = zeros;
      }
    }
  }

  /// A material whose coat or anisotropy has a direction needs tangents, which viewers derive from
  /// the coordinates of a normal map; a flat one changes nothing else.
  void add_normal_map(const Json& primitive) {
    if (!primitive.contains("material") || primitive["attributes"].contains("TANGENT")) return;
    Json& material = document_["materials"][primitive["material"].get<std::size_t>()];
    if (material.contains("normalTexture") || !material.contains("extensions")) return;
    const Json& extensions = material["extensions"];
    const auto has = [&](const char* extension, const char* texture) {
      return extensions.contains(extension) && extensions[extension].contains(texture);
    };
    const bool needs_tangents = has("KHR_materials_clearcoat", "clearcoatNormalTexture") ||
                                extensions.contains("KHR_materials_anisotropy");
    if (!needs_tangents) return;
    if (flat_normals_ == kNone) {
      Json& images = list_of(document_, "images");
      images.push_back({{"uri", kFlatNormals}});
      Json& textures = list_of(document_, "textures");
      textures.push_back({{"source", images.size() - 1}});
      flat_normals_ = static_cast<std::uint32_t>(textures.size() - 1);
    }
    material["normalTexture"] = {{"index", flat_normals_}};
  }

  Json& document_;
  std::set<std::size_t> without_triangles_;                           ///< In /meshes.
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> zeros_;  ///< By count, components.
  std::uint32_t flat_normals_ = kNone;                                ///< In /textures.
};

}  // namespace

void repair_meshes(Json& document) { MeshRepair(document).run(); }

}  // namespace sunder::gltf
