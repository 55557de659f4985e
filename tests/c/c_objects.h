#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/operation.h>

#include <string>
#include <string_view>
#include <sunder_c.h>
#include <vector>

#include <gtest/gtest.h>

#include "support/models/rich_mesh.h"
#include "support/models/rigs.h"

namespace sunder::test {

/// Expects success and prints the failure.
#define EXPECT_DONE(call) EXPECT_EQ(call, SUNDER_OK) << sunder_last_error()

/// The tube of make_tube() with attributes of every kind, and its clip.
inline Character rich_character() {
  Character character = make_tube(5, 7, 4);
  character.meshes[0] = rich_mesh();
  return character;
}

/// The arrays of a character as a C program has them. The character outlives them.
class CArrays {
 public:
  explicit CArrays(const Character& character);
  CArrays(const CArrays&) = delete;
  CArrays& operator=(const CArrays&) = delete;

  sunder_character_data data = {};

 private:
  struct OfMesh {
    std::vector<const float*> uv_sets, color_sets;
    std::vector<sunder_attribute> attributes;
    std::vector<sunder_influence> influences;
    std::vector<sunder_morph_target> targets;
    std::vector<sunder_submesh> submeshes;
  };
  static sunder_mesh arrays_of(const Mesh& mesh, OfMesh& tables);

  std::vector<sunder_bone> bones_;
  std::vector<sunder_skin> skins_;
  std::vector<OfMesh> tables_;
  std::vector<sunder_mesh> meshes_;
  std::vector<std::vector<sunder_channel>> channels_;
  std::vector<sunder_clip> clips_;
};

inline sunder_mesh CArrays::arrays_of(const Mesh& mesh, OfMesh& tables) {
  sunder_mesh out = {};
  for (const auto& set : mesh.uv_sets) tables.uv_sets.push_back(set[0].data());
  for (const auto& set : mesh.color_sets) tables.color_sets.push_back(set[0].data());
  for (const auto& one : mesh.custom_attributes)
    tables.attributes.push_back(
        {one.name.c_str(), one.values.data(), one.components, one.interpolates ? 0u : 1u});
  for (const Influence& one : mesh.weights.influences)
    tables.influences.push_back({one.slot, one.weight});
  const auto numbers = [](const std::vector<Vec3f>& of) {
    return of.empty() ? nullptr : of[0].data();
  };
  for (const MorphTarget& one : mesh.morph_targets)
    tables.targets.push_back({one.name.c_str(), numbers(one.position_deltas),
                              numbers(one.normal_deltas), numbers(one.tangent_deltas)});
  for (const Submesh& one : mesh.submeshes)
    tables.submeshes.push_back({one.name.c_str(), one.material, 0});
  out.name = mesh.name.c_str();
  out.positions = numbers(mesh.positions);
  out.normals = numbers(mesh.normals);
  out.tangents = mesh.tangents.empty() ? nullptr : mesh.tangents[0].data();
  out.uv_sets = tables.uv_sets.data();
  out.color_sets = tables.color_sets.data();
  out.attributes = tables.attributes.data();
  out.first_influence = mesh.weights.first.data();
  out.influences = tables.influences.data();
  out.morph_targets = tables.targets.data();
  out.triangles = mesh.triangles[0].data();
  out.triangle_submesh = mesh.triangle_submesh.data();
  out.submeshes = tables.submeshes.data();
  out.skin = mesh.skin;
  out.vertex_count = mesh.vertex_count();
  out.triangle_count = mesh.triangle_count();
  out.uv_set_count = static_cast<std::uint32_t>(tables.uv_sets.size());
  out.color_set_count = static_cast<std::uint32_t>(tables.color_sets.size());
  out.attribute_count = static_cast<std::uint32_t>(tables.attributes.size());
  out.morph_target_count = static_cast<std::uint32_t>(tables.targets.size());
  out.first_morph_weight = mesh.first_morph_weight;
  out.submesh_count = static_cast<std::uint32_t>(tables.submeshes.size());
  return out;
}

inline CArrays::CArrays(const Character& character)
    : tables_(character.meshes.size()), channels_(character.clips.size()) {
  for (const Bone& bone : character.skeleton.bones) {
    sunder_bone out = {bone.name.c_str(), bone.parent, {}, 0};
    for (int i = 0; i < 3; ++i) out.rest.translation[i] = bone.rest.translation[i];
    for (int i = 0; i < 4; ++i) out.rest.rotation[i] = bone.rest.rotation.coeffs()[i];
    for (int i = 0; i < 3; ++i) out.rest.scale[i] = bone.rest.scale[i];
    bones_.push_back(out);
  }
  for (const Skin& skin : character.skins)
    skins_.push_back({skin.name.c_str(), skin.bones.data(), skin.bone_from_bind[0].data(),
                      static_cast<std::uint32_t>(skin.bones.size()), 0});
  for (std::size_t m = 0; m < tables_.size(); ++m)
    meshes_.push_back(arrays_of(character.meshes[m], tables_[m]));
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    for (const Channel& one : character.clips[c].channels)
      channels_[c].push_back({one.times.data(), one.values.data(),
                              static_cast<std::uint32_t>(one.times.size()),
                              static_cast<std::uint32_t>(one.target), one.index, one.width,
                              static_cast<std::uint32_t>(one.interpolation), 0});
    clips_.push_back({character.clips[c].name.c_str(), channels_[c].data(),
                      static_cast<std::uint32_t>(channels_[c].size()),
                      character.clips[c].duration});
  }
  data = sunder_default_character_data();
  data.name = character.name.c_str();
  data.bones = bones_.data();
  data.skins = skins_.data();
  data.meshes = meshes_.data();
  data.clips = clips_.data();
  data.rest_morph_weights = character.rest_morph_weights.data();
  data.bone_count = static_cast<std::uint32_t>(bones_.size());
  data.skin_count = static_cast<std::uint32_t>(skins_.size());
  data.mesh_count = static_cast<std::uint32_t>(meshes_.size());
  data.clip_count = static_cast<std::uint32_t>(clips_.size());
  data.morph_weight_count = static_cast<std::uint32_t>(character.rest_morph_weights.size());
}

inline sunder_character create(const Character& character) {
  const CArrays arrays(character);
  sunder_character handle = 0;
  EXPECT_DONE(sunder_create_character(&arrays.data, &handle));
  return handle;
}

/// The bytes of a handle, which is destroyed.
inline std::string take_bytes(sunder_bytes bytes) {
  const std::uint8_t* data = nullptr;
  std::uint64_t size = 0;
  EXPECT_DONE(sunder_get_bytes(bytes, &data, &size));
  std::string copy(reinterpret_cast<const char*>(data), size);
  EXPECT_DONE(sunder_destroy_bytes(bytes));
  return copy;
}

inline sunder_blade blade_of(const Blade& blade) {
  sunder_blade out;
  for (int i = 0; i < 3; ++i) out.base[i] = blade.base[i], out.tip[i] = blade.tip[i];
  return out;
}

inline std::vector<sunder_blade> blades_of(const Stroke& stroke) {
  std::vector<sunder_blade> blades;
  for (const Blade& blade : stroke) blades.push_back(blade_of(blade));
  return blades;
}

/// A view that calls may write to.
inline sunder_posed_mesh posed_mesh(sunder_scene scene, sunder_instance instance,
                                    std::uint32_t mesh, std::uint64_t seen = 0) {
  sunder_posed_mesh posed = {};
  posed.struct_size = sizeof posed;
  EXPECT_DONE(sunder_get_posed_mesh(scene, instance, mesh, seen, &posed));
  return posed;
}

}  // namespace sunder::test
