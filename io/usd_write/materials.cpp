#include "io/usd_write/materials.h"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "io/gltf/refusal.h"
#include "io/gltf_write/mesh_writer.h"
#include "io/usd_write/checksum.h"
#include "io/usd_write/identifiers.h"

namespace sunder::usd {
namespace {

std::string tuple(std::span<const float> values) {
  std::string text = "(";
  for (const float value : values) text += (text.size() == 1 ? "" : ", ") + number(value);
  return text + ")";
}

std::string rgb(const Vec3f& colour) { return tuple({colour.data(), 3}); }
std::string rgba(const Vec4f& colour) { return tuple({colour.data(), 4}); }

const char* wrap_name(BaseColour::Wrap wrap) {
  constexpr const char* kNames[] = {"\"repeat\"", "\"clamp\"", "\"mirror\""};
  return kNames[static_cast<std::size_t>(wrap)];
}

/// Of an image, in hexadecimal digits: a part of its name, so that a file of another model that has
/// the name is very likely the same image.
std::string content_digits(const std::vector<std::byte>& bytes) {
  std::array<char, 9> digits;
  std::snprintf(digits.data(), digits.size(), "%08" PRIx32, checksum(bytes));
  return digits.data();
}

/// "st", "st1" …, as meshes name their texture coordinates.
std::string coordinates_name(std::uint32_t uv_set) {
  return uv_set == 0 ? "st" : "st" + std::to_string(uv_set);
}

/// A connection to a texture's output; its kind names the prim.
void connect(UsdText& text, const char* input, const std::string& material_path, const char* kind,
             const char* output) {
  text.line(std::string(input) + ".connect = <" + material_path + "/" + kind +
            ".outputs:" + output + ">");
}

}  // namespace

Materials::Materials(const Character& character, const SourceDocument* source,
                     const SaveOptions& options, std::string scope, std::string textures_folder)
    : scope_(std::move(scope)) {
  if (source != nullptr) {
    gltf::SurfaceMaterials read = gltf::read_surface_materials(*source, kMostImageBytes);
    materials_ = std::move(read.materials);
    images_ = std::move(read.images);
    left_out_ = read.left_out;
  }
  add_appended(options.materials);
  name_used(character, source != nullptr);
  for (std::size_t i = 0; i < images_.size(); ++i) {
    const std::string& type = images_[i].type;
    const char* const ending =
        type == "image/png" ? ".png" : (type == "image/jpeg" ? ".jpg" : nullptr);
    if (ending == nullptr) ++left_out_;
    file_of_.push_back(ending == nullptr ? std::string()
                                         : textures_folder + "/image_" + std::to_string(i) + "_" +
                                               content_digits(images_[i].bytes) + ending);
  }
  is_image_written_.assign(images_.size(), false);
}

void Materials::add_appended(const std::vector<AppendedMaterial>& appended) {
  for (const AppendedMaterial& of : appended) {
    Material material;
    material.name = of.name;
    material.base_colour = of.base_colour;
    material.metallic = of.metallic;
    material.roughness = of.roughness;
    material.is_double_sided = of.double_sided;
    if (of.base_colour.w() < 1) material.alpha = Material::Alpha::blend;
    materials_.push_back(std::move(material));
  }
}

void Materials::name_used(const Character& character, bool has_source) {
  std::vector<bool> is_used(materials_.size(), false);
  has_vertex_colours_.assign(materials_.size(), false);
  for (const Mesh& mesh : character.meshes) {
    if (!gltf::MeshWriter::has_triangles(mesh)) continue;
    for (const Submesh& submesh : mesh.submeshes) {
      if (submesh.material == kNone || (!has_source && materials_.empty())) continue;
      if (submesh.material >= materials_.size())
        gltf::refuse(StatusCode::index_out_of_range, submesh.material,
                     "mesh '%.60s': material %u does not exist; there are %zu", mesh.name.c_str(),
                     submesh.material, materials_.size());
      is_used[submesh.material] = true;
      if (!mesh.color_sets.empty()) has_vertex_colours_[submesh.material] = true;
      is_any_used_ = true;
    }
  }
  Identifiers taken;
  for (std::size_t i = 0; i < materials_.size(); ++i)
    names_.push_back(is_used[i] ? taken.add(materials_[i].name, "Material") : std::string());
}

std::string Materials::path_of(const Submesh& submesh) const {
  if (submesh.material >= names_.size()) return {};
  return scope_ + "/" + names_[submesh.material];
}

bool Materials::is_double_sided(const Submesh& submesh) const {
  return submesh.material < materials_.size() && materials_[submesh.material].is_double_sided;
}

bool Materials::has_image(const Texture& texture) const {
  return texture.image < file_of_.size() && !file_of_[texture.image].empty();
}

bool Materials::shows_vertex_colours(std::size_t material) const {
  return has_vertex_colours_[material] && !has_image(materials_[material].base_texture) &&
         materials_[material].base_colour.head<3>() == Vec3f::Ones();
}

void Materials::write(UsdText& text) {
  if (!is_any_used_) return;
  text.line("");
  text.open_prim("Scope", scope_.substr(scope_.rfind('/') + 1));
  for (std::size_t i = 0; i < materials_.size(); ++i)
    if (!names_[i].empty()) write_material(text, i);
  text.close('}');
}

void Materials::write_material(UsdText& text, std::size_t index) {
  const Material& material = materials_[index];
  const std::string path = scope_ + "/" + names_[index];
  text.open_prim("Material", names_[index], display_name(material.name, names_[index]));
  text.line("token outputs:surface.connect = <" + path + "/Surface.outputs:surface>");
  text.line("");
  write_surface(text, index, path);
  if (shows_vertex_colours(index)) write_vertex_colour(text);
  const Vec3f& emission = material.emission;
  const float s = material.normal_scale, strength = material.occlusion_strength;
  write_texture(text, path, "BaseColour", material.base_texture,
                {material.base_colour, Vec4f::Zero(), true});
  write_texture(text, path, "MetallicRoughness", material.metallic_roughness_texture,
                {Vec4f(1, material.roughness, material.metallic, 1), Vec4f::Zero(), false});
  write_texture(text, path, "Normal", material.normal_texture,
                {Vec4f(2 * s, 2 * s, 2, 1), Vec4f(-s, -s, -1, 0), false});
  write_texture(text, path, "Occlusion", material.occlusion_texture,
                {Vec4f(strength, strength, strength, 1),
                 Vec4f(1 - strength, 1 - strength, 1 - strength, 0), false});
  write_texture(text, path, "Emission", material.emission_texture,
                {Vec4f(emission.x(), emission.y(), emission.z(), 1), Vec4f::Zero(), true});
  text.close('}');
}

void Materials::write_surface(UsdText& text, std::size_t index, const std::string& path) const {
  const Material& material = materials_[index];
  text.open_prim("Shader", "Surface");
  text.line("uniform token info:id = \"UsdPreviewSurface\"");
  if (has_image(material.base_texture))
    connect(text, "color3f inputs:diffuseColor", path, "BaseColour", "rgb");
  else if (shows_vertex_colours(index))
    connect(text, "color3f inputs:diffuseColor", path, "VertexColour", "result");
  else
    text.line("color3f inputs:diffuseColor = " + rgb(material.base_colour.head<3>()));
  if (has_image(material.metallic_roughness_texture)) {
    connect(text, "float inputs:metallic", path, "MetallicRoughness", "b");
    connect(text, "float inputs:roughness", path, "MetallicRoughness", "g");
  } else {
    text.line("float inputs:metallic = " + number(material.metallic));
    text.line("float inputs:roughness = " + number(material.roughness));
  }
  if (has_image(material.normal_texture))
    connect(text, "normal3f inputs:normal", path, "Normal", "rgb");
  if (has_image(material.occlusion_texture))
    connect(text, "float inputs:occlusion", path, "Occlusion", "r");
  if (has_image(material.emission_texture))
    connect(text, "color3f inputs:emissiveColor", path, "Emission", "rgb");
  else if (material.emission.maxCoeff() > 0)
    text.line("color3f inputs:emissiveColor = " + rgb(material.emission));
  write_alpha(text, material, path);
  text.line("token outputs:surface");
  text.close('}');
}

void Materials::write_vertex_colour(UsdText& text) {
  text.line("");
  text.open_prim("Shader", "VertexColour");
  text.line("uniform token info:id = \"UsdPrimvarReader_float3\"");
  text.line("string inputs:varname = \"displayColor\"");
  text.line("float3 inputs:fallback = (1, 1, 1)");
  text.line("float3 outputs:result");
  text.close('}');
}

void Materials::write_alpha(UsdText& text, const Material& material,
                            const std::string& path) const {
  if (material.alpha == Material::Alpha::opaque) return;
  if (has_image(material.base_texture))
    connect(text, "float inputs:opacity", path, "BaseColour", "a");
  else
    text.line("float inputs:opacity = " + number(material.base_colour.w()));
  // A threshold of zero would mean that there is none.
  if (material.alpha == Material::Alpha::mask)
    text.line("float inputs:opacityThreshold = " + number(std::max(material.cutoff, 1e-6f)));
}

void Materials::write_texture(UsdText& text, const std::string& material_path, const char* kind,
                              const Texture& texture, const Reading& reading) {
  if (!has_image(texture)) return;
  is_image_written_[texture.image] = true;
  const std::string coordinates = kind + std::string("Coordinates");
  text.line("");
  text.open_prim("Shader", kind);
  text.line("uniform token info:id = \"UsdUVTexture\"");
  text.line("asset inputs:file = @./" + file_of_[texture.image] + "@");
  if (reading.scale != Vec4f::Ones()) text.line("float4 inputs:scale = " + rgba(reading.scale));
  if (reading.bias != Vec4f::Zero()) text.line("float4 inputs:bias = " + rgba(reading.bias));
  text.line(std::string("token inputs:sourceColorSpace = ") +
            (reading.is_colour ? "\"sRGB\"" : "\"raw\""));
  connect(text, "float2 inputs:st", material_path, coordinates.c_str(), "result");
  text.line(std::string("token inputs:wrapS = ") + wrap_name(texture.wrap_u));
  text.line(std::string("token inputs:wrapT = ") + wrap_name(texture.wrap_v));
  for (const char* const output : {"float outputs:r", "float outputs:g", "float outputs:b",
                                   "float outputs:a", "float3 outputs:rgb"})
    text.line(output);
  text.close('}');
  write_coordinates(text, material_path, kind, texture);
}

void Materials::write_coordinates(UsdText& text, const std::string& material_path, const char* kind,
                                  const Texture& texture) const {
  const auto& m = texture.image_from_uv;
  const bool is_moved = m != Eigen::Matrix<float, 2, 3>::Identity();
  const std::string coordinates = kind + std::string("Coordinates");
  const std::string unmoved = kind + std::string("Unmoved");
  text.line("");
  if (is_moved) {
    // The same map for coordinates whose v counts upwards: scaled, then turned, then moved.
    const float scale_u = std::hypot(m(0, 0), m(1, 0)), angle = std::atan2(-m(1, 0), m(0, 0));
    const float scale_v = std::sin(angle) * m(0, 1) + std::cos(angle) * m(1, 1);
    text.open_prim("Shader", coordinates);
    text.line("uniform token info:id = \"UsdTransform2d\"");
    connect(text, "float2 inputs:in", material_path, unmoved.c_str(), "result");
    text.line("float inputs:rotation = " + number(angle * 180 / std::numbers::pi_v<float>));
    text.line("float2 inputs:scale = (" + number(scale_u) + ", " + number(scale_v) + ")");
    text.line("float2 inputs:translation = (" + number(m(0, 1) + m(0, 2)) + ", " +
              number(1 - m(1, 1) - m(1, 2)) + ")");
    text.line("float2 outputs:result");
    text.close('}');
    text.line("");
  }
  text.open_prim("Shader", is_moved ? unmoved : coordinates);
  text.line("uniform token info:id = \"UsdPrimvarReader_float2\"");
  text.line("string inputs:varname = \"" + coordinates_name(texture.uv_set) + "\"");
  text.line("float2 outputs:result");
  text.close('}');
}

std::vector<UsdLayer::Texture> Materials::take_textures() {
  std::vector<UsdLayer::Texture> textures;
  for (std::size_t i = 0; i < images_.size(); ++i)
    if (is_image_written_[i]) textures.push_back({file_of_[i], std::move(images_[i].bytes)});
  return textures;
}

}  // namespace sunder::usd
