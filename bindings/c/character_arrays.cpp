// A character from the arrays of sunder_character_data. Sizes and null pointers are checked here;
// validate_character() checks the rest.

#include <cstring>
#include <string>
#include <type_traits>

#include "bindings/c/character.h"

namespace sunder::c {
namespace {

/// The failure of an array that is missing; caught by copy_character().
struct Missing {
  Status status;
};

/// Refuses a null array of `count` elements. @param of  what it belongs to: "mesh", "skin" …
void require_array(const void* values, std::uint64_t count, const char* of, std::size_t index,
                   const char* array) {
  if (values == nullptr && count > 0)
    throw Missing{Status::failure(StatusCode::size_mismatch, static_cast<std::uint32_t>(index),
                                  "%s %zu: `%s` is null; expected %llu elements", of, index, array,
                                  static_cast<unsigned long long>(count))};
}

void refuse_enum(std::uint32_t value, const char* of, std::size_t index, const char* field) {
  throw Missing{Status::failure(StatusCode::invalid_argument, static_cast<std::uint32_t>(index),
                                "%s %zu: `%s` is %u", of, index, field, value)};
}

std::string text_of(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

/// Copies numbers into vectors (or triangles) of the same layout.
template <class T, class Number>
std::vector<T> copied(const Number* values, std::size_t count) {
  static_assert(sizeof(T) % sizeof(Number) == 0);
  std::vector<T> copy(values == nullptr ? 0 : count);
  if (!copy.empty()) std::memcpy(static_cast<void*>(copy.data()), values, copy.size() * sizeof(T));
  return copy;
}

Skin copy_skin(const sunder_skin& from, std::size_t index) {
  require_array(from.bones, from.slot_count, "skin", index, "bones");
  require_array(from.bone_from_bind, from.slot_count, "skin", index, "bone_from_bind");
  Skin skin;
  skin.name = text_of(from.name);
  skin.bones = copied<std::uint32_t>(from.bones, from.slot_count);
  skin.bone_from_bind = copied<Affine3f>(from.bone_from_bind, from.slot_count);
  return skin;
}

void copy_attributes(const sunder_mesh& from, std::size_t index, Mesh& mesh) {
  const std::size_t vertices = from.vertex_count;
  require_array(from.uv_sets, from.uv_set_count, "mesh", index, "uv_sets");
  require_array(from.color_sets, from.color_set_count, "mesh", index, "color_sets");
  require_array(from.attributes, from.attribute_count, "mesh", index, "attributes");
  for (std::uint32_t i = 0; i < from.uv_set_count; ++i) {
    require_array(from.uv_sets[i], vertices, "mesh", index, "uv_sets[]");
    mesh.uv_sets.push_back(copied<Vec2f>(from.uv_sets[i], vertices));
  }
  for (std::uint32_t i = 0; i < from.color_set_count; ++i) {
    require_array(from.color_sets[i], vertices, "mesh", index, "color_sets[]");
    mesh.color_sets.push_back(copied<Vec4f>(from.color_sets[i], vertices));
  }
  for (std::uint32_t i = 0; i < from.attribute_count; ++i) {
    const sunder_attribute& one = from.attributes[i];
    if (one.components < 1 || one.components > 4)
      refuse_enum(one.components, "mesh", index, "attributes[].components");
    require_array(one.values, vertices, "mesh", index, "attributes[].values");
    mesh.custom_attributes.push_back({text_of(one.name), one.components, one.is_label == 0,
                                      copied<float>(one.values, vertices * one.components)});
  }
}

void copy_morph_targets(const sunder_mesh& from, std::size_t index, Mesh& mesh) {
  require_array(from.morph_targets, from.morph_target_count, "mesh", index, "morph_targets");
  for (std::uint32_t i = 0; i < from.morph_target_count; ++i) {
    const sunder_morph_target& target = from.morph_targets[i];
    mesh.morph_targets.push_back({text_of(target.name),
                                  copied<Vec3f>(target.position_deltas, from.vertex_count),
                                  copied<Vec3f>(target.normal_deltas, from.vertex_count),
                                  copied<Vec3f>(target.tangent_deltas, from.vertex_count)});
  }
}

void copy_influences(const sunder_mesh& from, std::size_t index, Mesh& mesh) {
  require_array(from.first_influence, std::uint64_t{from.vertex_count} + 1, "mesh", index,
                "first_influence");
  mesh.weights.first =
      copied<std::uint32_t>(from.first_influence, std::size_t{from.vertex_count} + 1);
  // The last offset says how many there are; that they ascend is checked with the rest.
  const std::uint32_t count = mesh.weights.first.back();
  require_array(from.influences, count, "mesh", index, "influences");
  mesh.weights.influences.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i)
    mesh.weights.influences.push_back({from.influences[i].slot, from.influences[i].weight});
}

void copy_triangles(const sunder_mesh& from, std::size_t index, Mesh& mesh) {
  require_array(from.triangles, from.triangle_count, "mesh", index, "triangles");
  require_array(from.submeshes, from.submesh_count, "mesh", index, "submeshes");
  mesh.triangles = copied<Triangle>(from.triangles, from.triangle_count);
  if (from.submesh_count == 0 && from.triangle_count > 0) {
    mesh.submeshes.emplace_back();
    mesh.triangle_submesh.assign(from.triangle_count, 0);
    return;
  }
  require_array(from.triangle_submesh, from.triangle_count, "mesh", index, "triangle_submesh");
  mesh.triangle_submesh = copied<std::uint32_t>(from.triangle_submesh, from.triangle_count);
  for (std::uint32_t i = 0; i < from.submesh_count; ++i)
    mesh.submeshes.push_back({text_of(from.submeshes[i].name), from.submeshes[i].material});
}

Mesh copy_mesh(const sunder_mesh& from, std::size_t index) {
  require_array(from.positions, from.vertex_count, "mesh", index, "positions");
  Mesh mesh;
  mesh.name = text_of(from.name);
  mesh.skin = from.skin;
  mesh.positions = copied<Vec3f>(from.positions, from.vertex_count);
  mesh.normals = copied<Vec3f>(from.normals, from.vertex_count);
  mesh.tangents = copied<Vec4f>(from.tangents, from.vertex_count);
  mesh.first_morph_weight = from.first_morph_weight;
  copy_attributes(from, index, mesh);
  copy_morph_targets(from, index, mesh);
  copy_influences(from, index, mesh);
  copy_triangles(from, index, mesh);
  return mesh;
}

Clip copy_clip(const sunder_clip& from, std::size_t index) {
  require_array(from.channels, from.channel_count, "clip", index, "channels");
  Clip clip;
  clip.name = text_of(from.name);
  clip.duration = from.duration;
  for (std::uint32_t i = 0; i < from.channel_count; ++i) {
    const sunder_channel& channel = from.channels[i];
    if (channel.target > SUNDER_TARGET_MORPH_WEIGHTS)
      refuse_enum(channel.target, "clip", index, "channels[].target");
    if (channel.interpolation > SUNDER_INTERPOLATE_CUBIC)
      refuse_enum(channel.interpolation, "clip", index, "channels[].interpolation");
    const std::uint64_t values = std::uint64_t{channel.key_count} * channel.width *
                                 (channel.interpolation == SUNDER_INTERPOLATE_CUBIC ? 3 : 1);
    require_array(channel.times, channel.key_count, "clip", index, "channels[].times");
    require_array(channel.values, values, "clip", index, "channels[].values");
    clip.channels.push_back({static_cast<ChannelTarget>(channel.target), channel.index,
                             channel.width, static_cast<Interpolation>(channel.interpolation),
                             copied<float>(channel.times, channel.key_count),
                             copied<float>(channel.values, values)});
  }
  return clip;
}

}  // namespace

Result<Character> copy_character(const sunder_character_data& data) {
  try {
    require_array(data.bones, data.bone_count, "character", 0, "bones");
    require_array(data.skins, data.skin_count, "character", 0, "skins");
    require_array(data.meshes, data.mesh_count, "character", 0, "meshes");
    require_array(data.clips, data.clip_count, "character", 0, "clips");
    require_array(data.rest_morph_weights, data.morph_weight_count, "character", 0,
                  "rest_morph_weights");
    Character character;
    character.name = text_of(data.name);
    for (std::uint32_t i = 0; i < data.bone_count; ++i)
      character.skeleton.bones.push_back(
          {text_of(data.bones[i].name), data.bones[i].parent, transform_of(data.bones[i].rest)});
    for (std::uint32_t i = 0; i < data.skin_count; ++i)
      character.skins.push_back(copy_skin(data.skins[i], i));
    for (std::uint32_t i = 0; i < data.mesh_count; ++i)
      character.meshes.push_back(copy_mesh(data.meshes[i], i));
    for (std::uint32_t i = 0; i < data.clip_count; ++i)
      character.clips.push_back(copy_clip(data.clips[i], i));
    character.rest_morph_weights = copied<float>(data.rest_morph_weights, data.morph_weight_count);
    return character;
  } catch (const Missing& missing) {
    return missing.status;
  }
}

}  // namespace sunder::c
