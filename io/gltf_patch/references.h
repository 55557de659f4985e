#pragma once

#include <span>

#include "io/gltf/source_document.h"
#include "io/gltf_write/torn_record.h"

namespace sunder::gltf {

/// What an accessor or a buffer view is used as.
enum class Use { vertices, indices, binds, key_times, key_values, sparse, image };

/// The entries of a list of an object; none if it has no such list.
inline std::span<Json> list_in(Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_array()) return {};
  return found->get_ref<Json::array_t&>();
}

/// Calls visit(reference, use) for the accessors of a primitive that follows the schema.
template <class Visit>
void visit_primitive(Json& primitive, const Visit& visit) {
  if (!primitive.is_object()) return;
  for (auto& item : primitive["attributes"].items()) visit(item.value(), Use::vertices);
  if (primitive.contains("indices")) visit(primitive["indices"], Use::indices);
  for (Json& target : list_in(primitive, "targets"))
    for (auto& item : target.items()) visit(item.value(), Use::vertices);
}

/// Calls visit(reference, use) for every reference of core glTF to an accessor, in a document that
/// follows the schema.
template <class Visit>
void visit_accessors(Json& document, const Visit& visit) {
  for (Json& mesh : list_in(document, "meshes"))
    for (Json& primitive : list_in(mesh, "primitives")) visit_primitive(primitive, visit);
  for (Json& skin : list_in(document, "skins"))
    if (skin.contains("inverseBindMatrices")) visit(skin["inverseBindMatrices"], Use::binds);
  for (Json& animation : list_in(document, "animations"))
    for (Json& sampler : list_in(animation, "samplers")) {
      visit(sampler["input"], Use::key_times);
      visit(sampler["output"], Use::key_values);
    }
}

/// Calls visit(reference) for the accessors of EXT_mesh_gpu_instancing, as far as they exist.
template <class Visit>
void visit_instance_accessors(Json& document, const Visit& visit) {
  const std::size_t count = count_of(document, "accessors");
  for (Json& node : list_in(document, "nodes")) {
    if (!node.contains("extensions")) continue;
    Json& extensions = node["extensions"];
    if (!extensions.is_object() || !extensions.contains("EXT_mesh_gpu_instancing")) continue;
    Json& instancing = extensions["EXT_mesh_gpu_instancing"];
    if (!instancing.is_object() || !instancing.contains("attributes")) continue;
    if (!instancing["attributes"].is_object()) continue;
    for (auto& item : instancing["attributes"].items())
      if (item.value().is_number_unsigned() && item.value().get<std::uint64_t>() < count)
        visit(item.value());
  }
}

/// Calls visit(reference) for the accessors of SUNDER_torn_mesh, as far as they exist.
template <class Visit>
void visit_record_accessors(Json& document, const Visit& visit) {
  const std::size_t count = count_of(document, "accessors");
  for (Json& mesh : list_in(document, "meshes"))
    for (Json& primitive : list_in(mesh, "primitives")) {
      if (!primitive.contains("extensions")) continue;
      Json& extensions = primitive["extensions"];
      if (!extensions.is_object() || !extensions.contains(kTornMesh)) continue;
      Json& record = extensions[kTornMesh];
      if (!record.is_object()) continue;
      for (const char* const name : kTornMeshAccessors)
        if (record.contains(name) && record[name].is_number_unsigned() &&
            record[name].get<std::uint64_t>() < count)
          visit(record[name]);
    }
}

/// Calls visit(reference, is_sparse) for the views of an accessor.
template <class Visit>
void visit_views_of(Json& accessor, const Visit& visit) {
  if (accessor.contains("bufferView")) visit(accessor["bufferView"], false);
  if (!accessor.contains("sparse")) return;
  for (const char* const part : {"indices", "values"})
    visit(accessor["sparse"][part]["bufferView"], true);
}

}  // namespace sunder::gltf
