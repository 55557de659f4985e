#include "io/gltf_patch/foreign_indices.h"

#include <algorithm>
#include <string_view>

#include "io/gltf_write/torn_record.h"

namespace sunder::gltf {
namespace {

/// Extensions that refer to no accessor and no buffer view but those that references.h visits.
struct KnownExtension {
  std::string_view beginning;  ///< Of the name.
  bool names_meshes = false;
};
constexpr KnownExtension kKnown[] = {{"KHR_materials_"},
                                     {"KHR_texture_"},
                                     {"EXT_texture_"},
                                     {"MSFT_texture_"},
                                     {"MSFT_packing_"},
                                     {"KHR_lights_punctual"},
                                     {"EXT_lights_image_based"},
                                     {"KHR_mesh_quantization"},
                                     {"KHR_node_"},
                                     {"KHR_xmp"},
                                     {"MSFT_lod"},
                                     {"EXT_mesh_gpu_instancing"},
                                     {"GODOT_single_root"},
                                     {kTornMesh},
                                     {"KHR_animation_pointer", true},
                                     {"VRMC_"},
                                     {"VRM", true}};

class Scan {
 public:
  ForeignIndices take() { return std::move(found_); }

  void visit(const Json& value) {
    if (value.is_array())
      for (const Json& entry : value) visit(entry);
    if (!value.is_object()) return;
    for (const auto& [key, member] : value.items()) {
      if (key == "extras") continue;
      if (key == "extensions" && member.is_object())
        for (const auto& [name, extension] : member.items()) visit_extension(name, extension);
      else
        visit(member);
    }
  }

 private:
  void visit_extension(std::string_view name, const Json& extension) {
    const auto* const known =
        std::find_if(std::begin(kKnown), std::end(kKnown),
                     [&](const KnownExtension& one) { return name.starts_with(one.beginning); });
    const bool is_known = known != std::end(kKnown);
    found_.exist |= !is_known;
    found_.may_name_meshes |= !is_known || known->names_meshes;
    if (is_known)
      visit(extension);
    else
      collect(extension);
  }

  void collect(const Json& value) {
    if (value.is_number_unsigned()) found_.numbers.insert(value.get<std::uint64_t>());
    if (value.is_array())
      for (const Json& entry : value) collect(entry);
    if (!value.is_object()) return;
    for (const auto& [key, member] : value.items()) {
      found_.may_name_bytes |= key == "buffer" || key == "byteOffset";
      if (key != "extras") collect(member);
    }
  }

  ForeignIndices found_;
};

}  // namespace

ForeignIndices foreign_indices(const Json& document) {
  Scan scan;
  scan.visit(document);
  return scan.take();
}

}  // namespace sunder::gltf
