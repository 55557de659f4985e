#include "io/gltf_write/appended_materials.h"

#include <algorithm>
#include <utility>

#include "io/gltf/cursor.h"
#include "io/gltf_write/lists.h"

namespace sunder::gltf {

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
}

}  // namespace sunder::gltf
