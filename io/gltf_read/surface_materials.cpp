#include "io/gltf_read/surface_materials.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/gltf_read/material_parts.h"

namespace sunder::gltf {
namespace {

float finite_or(const Json& value, float otherwise) {
  if (!value.is_number()) return otherwise;
  const auto number = value.get<float>();
  return std::isfinite(number) ? number : otherwise;
}

class SurfaceReader {
 public:
  SurfaceReader(const SourceDocument& source, std::uint64_t maximum_bytes)
      : source_(source), images_(source, maximum_bytes) {}

  SurfaceMaterials read() {
    SurfaceMaterials found;
    if (const Json& materials = member(source_.json, "materials"); materials.is_array())
      for (const Json& material : materials) found.materials.push_back(read(material));
    found.images = std::move(images_.all());
    found.left_out = images_.left_out();
    return found;
  }

 private:
  SurfaceMaterial read(const Json& material) {
    SurfaceMaterial result;
    if (const Json& name = member(material, "name"); name.is_string())
      result.name = name.get<std::string>();
    const Json& surface = member(material, "pbrMetallicRoughness");
    for (std::size_t i = 0; i < 4; ++i) {
      const float share = number_or(surface, "baseColorFactor", i, 1);
      result.base_colour[static_cast<int>(i)] = std::clamp(share, 0.0f, 1.0f);
    }
    result.metallic = share_or(member(surface, "metallicFactor"), 1);
    result.roughness = share_or(member(surface, "roughnessFactor"), 1);
    result.base_texture = texture(member(surface, "baseColorTexture"));
    result.metallic_roughness_texture = texture(member(surface, "metallicRoughnessTexture"));
    const Json& normal = member(material, "normalTexture");
    result.normal_texture = texture(normal);
    result.normal_scale = finite_or(member(normal, "scale"), 1);
    const Json& occlusion = member(material, "occlusionTexture");
    result.occlusion_texture = texture(occlusion);
    result.occlusion_strength = share_or(member(occlusion, "strength"), 1);
    result.emission = emission_of(material);
    if (result.emission.maxCoeff() > 0)
      result.emission_texture = texture(member(material, "emissiveTexture"));
    const Json& mode = member(material, "alphaMode");
    if (mode == "MASK") result.alpha = SurfaceMaterial::Alpha::mask;
    if (mode == "BLEND") result.alpha = SurfaceMaterial::Alpha::blend;
    result.cutoff = share_or(member(material, "alphaCutoff"), 0.5f);
    result.is_double_sided = member(material, "doubleSided") == true;
    return result;
  }

  SurfaceTexture texture(const Json& reference) {
    SurfaceTexture result;
    const Json& of = entry(source_.json, "textures", member(reference, "index"));
    if (!of.is_object()) return result;
    result.image = images_.of_texture(of);
    const Json& transform = member(member(reference, "extensions"), "KHR_texture_transform");
    for (const Json* const object : {&reference, &transform})
      if (const Json& set = member(*object, "texCoord"); set.is_number_unsigned())
        if (const auto number = set.get<std::uint64_t>(); number < kNone)
          result.uv_set = static_cast<std::uint32_t>(number);
    result.image_from_uv = transform_of(transform);
    const Json& sampler = entry(source_.json, "samplers", member(of, "sampler"));
    result.wrap_u = wrap_of(sampler, "wrapS");
    result.wrap_v = wrap_of(sampler, "wrapT");
    return result;
  }

  const SourceDocument& source_;
  DocumentImages images_;
};

}  // namespace

SurfaceMaterials read_surface_materials(const SourceDocument& source, std::uint64_t maximum_bytes) {
  return SurfaceReader(source, maximum_bytes).read();
}

}  // namespace sunder::gltf
