#include "io/assimp/materials.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include "io/assimp/scene_tree.h"

namespace sunder::assimp_import {
namespace {

constexpr std::size_t kMaximumImageBytes = std::size_t{256} << 20;

/// The MIME type according to the first bytes; empty if glTF does not support it.
const char* image_type(std::span<const std::byte> bytes) {
  const std::string_view start(reinterpret_cast<const char*>(bytes.data()),
                               std::min<std::size_t>(bytes.size(), 8));
  if (start.starts_with("\x89PNG\r\n\x1A\n")) return "image/png";
  if (start.starts_with("\xFF\xD8\xFF")) return "image/jpeg";
  return "";
}

double unit(float value) {
  return std::isfinite(value) ? static_cast<double>(std::clamp(value, 0.0f, 1.0f)) : 1.0;
}

int wrap_mode(int assimp_mode) {
  switch (assimp_mode) {
    case aiTextureMapMode_Clamp:
    case aiTextureMapMode_Decal: return 33071;
    case aiTextureMapMode_Mirror: return 33648;
    default: return 10497;
  }
}

}  // namespace

std::optional<std::uint32_t> MaterialWriter::material_for(
    std::uint32_t material, std::span<const std::uint32_t> texcoord_of_channel) {
  if (material >= scene_.mNumMaterials || scene_.mMaterials[material] == nullptr)
    return std::nullopt;
  const Texture& texture = base_texture(material);
  const bool textured = texture.index != kNone && texture.channel < texcoord_of_channel.size();
  const std::uint32_t texcoord = textured ? texcoord_of_channel[texture.channel] : kNone;
  const auto known = written_.find({material, texcoord});
  if (known != written_.end()) return known->second;

  Json json = describe(material);
  if (texcoord != kNone) {
    Json& reference = json["pbrMetallicRoughness"]["baseColorTexture"];
    reference["index"] = texture.index;
    if (texcoord != 0) reference["texCoord"] = texcoord;
  }
  const std::uint32_t index = glb_.append("materials", std::move(json));
  written_.emplace(std::pair(material, texcoord), index);
  return index;
}

Json MaterialWriter::describe(std::uint32_t material) {
  const aiMaterial& source = *scene_.mMaterials[material];
  Json json = Json::object();
  aiString name;
  source.Get(AI_MATKEY_NAME, name);
  if (name.length > 0) json["name"] = valid_utf8(to_string(name));

  aiColor4D color(1.0f, 1.0f, 1.0f, 1.0f);
  if (source.Get(AI_MATKEY_BASE_COLOR, color) != aiReturn_SUCCESS &&
      source.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS)
    // Opacity has its own key; the fourth component of a diffuse colour is often zero or missing.
    color.a = 1.0f;
  float opacity = 1.0f;
  source.Get(AI_MATKEY_OPACITY, opacity);
  double alpha = unit(color.a) * unit(opacity);
  if (alpha == 0.0) {
    notes_.inform("materials",
                  "fully transparent, which is usually misread by the importer; made opaque");
    alpha = 1.0;
  }
  json["pbrMetallicRoughness"] = {
      {"baseColorFactor", {unit(color.r), unit(color.g), unit(color.b), alpha}},
      {"metallicFactor", 0.0},
      {"roughnessFactor", 1.0}};
  if (alpha < 1.0) json["alphaMode"] = "BLEND";
  int two_sided = 0;
  source.Get(AI_MATKEY_TWOSIDED, two_sided);
  if (two_sided != 0) json["doubleSided"] = true;
  return json;
}

const MaterialWriter::Texture& MaterialWriter::base_texture(std::uint32_t material) {
  const auto [entry, is_new] = texture_of_material_.try_emplace(material);
  if (!is_new) return entry->second;
  const aiMaterial& source = *scene_.mMaterials[material];
  for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
    aiString path;
    unsigned channel = 0;
    aiTextureMapMode wrap[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap,
                                aiTextureMapMode_Wrap};
    if (source.GetTexture(type, 0, &path, nullptr, &channel, nullptr, nullptr, wrap) !=
            aiReturn_SUCCESS ||
        path.length == 0)
      continue;
    aiUVTransform transform;
    if (source.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) == aiReturn_SUCCESS &&
        (transform.mRotation != 0.0f || transform.mScaling != aiVector2D(1.0f, 1.0f) ||
         transform.mTranslation != aiVector2D(0.0f, 0.0f)))
      notes_.inform("materials", "texture transforms are not carried over");
    entry->second = {texture_of(to_string(path), wrap_mode(wrap[0]), wrap_mode(wrap[1])), channel};
    break;
  }
  return entry->second;
}

std::uint32_t MaterialWriter::texture_of(const std::string& path, int wrap_u, int wrap_v) {
  const std::uint32_t image = image_of(path);
  if (image == kNone) return kNone;
  Json texture = {{"source", image}};
  if (wrap_u != 10497 || wrap_v != 10497)
    texture["sampler"] = glb_.append("samplers", {{"wrapS", wrap_u}, {"wrapT", wrap_v}});
  return glb_.append("textures", std::move(texture));
}

std::uint32_t MaterialWriter::image_of(const std::string& path) {
  const auto [entry, is_new] = image_of_path_.try_emplace(path, kNone);
  if (!is_new) return entry->second;
  const std::string place = "texture '" + valid_utf8(path) + "'";

  std::optional<std::vector<std::byte>> file;
  std::span<const std::byte> bytes;
  if (const aiTexture* embedded = scene_.GetEmbeddedTexture(path.c_str());
      embedded != nullptr && embedded->pcData != nullptr) {
    // mHeight of zero means an image file of mWidth bytes. Raw texels would need an encoder.
    if (embedded->mHeight == 0)
      bytes = {reinterpret_cast<const std::byte*>(embedded->pcData), embedded->mWidth};
  } else {
    file = folder_.read(path);
    if (!file) {
      // Absolute paths are common and name folders of the author's machine; the file is usually
      // next to the model.
      std::string flat = path;
      std::replace(flat.begin(), flat.end(), '\\', '/');
      file = folder_.read(std::filesystem::path(flat).filename().string());
    }
    if (!file) {
      notes_.inform(place, "not found in the model's folder; left out");
      return kNone;
    }
    bytes = *file;
  }
  const char* type = image_type(bytes);
  if (*type == '\0' || bytes.size() > kMaximumImageBytes) {
    notes_.inform(place, "neither PNG nor JPEG; left out");
    return kNone;
  }
  const std::uint32_t view = glb_.add_bytes(bytes);
  entry->second = glb_.append("images", {{"bufferView", view}, {"mimeType", type}});
  return entry->second;
}

}  // namespace sunder::assimp_import
