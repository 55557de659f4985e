#include <utility>

#include "bindings/c/character.h"
#include "bindings/c/numbers.h"

namespace sunder::c {
namespace {

// Arrays of these are handed out as arrays of numbers.
static_assert(sizeof(Vec2f) == 8 && sizeof(Vec3f) == 12 && sizeof(Vec4f) == 16);
static_assert(sizeof(Triangle) == 12 && sizeof(Influence) == sizeof(sunder_influence));
static_assert(sizeof(Affine3f) == 48 && sizeof(Affine3d) == 96);

template <class Values>
const typename Values::value_type* or_null(const Values& values) {
  return values.empty() ? nullptr : values.data();
}

std::vector<sunder_bone> bones_of(const Skeleton& skeleton) {
  std::vector<sunder_bone> bones;
  for (const Bone& bone : skeleton.bones)
    bones.push_back({bone.name.c_str(), bone.parent, transform_of(bone.rest), 0});
  return bones;
}

std::vector<sunder_skin> skins_of(const Character& character) {
  std::vector<sunder_skin> skins;
  for (const Skin& skin : character.skins)
    skins.push_back({skin.name.c_str(), or_null(skin.bones),
                     skin.bone_from_bind.empty() ? nullptr : skin.bone_from_bind.front().data(),
                     count_of(skin.bones), 0});
  return skins;
}

std::vector<sunder_channel> channels_of(const Clip& clip) {
  std::vector<sunder_channel> channels;
  for (const Channel& channel : clip.channels)
    channels.push_back({channel.times.data(), or_null(channel.values), count_of(channel.times),
                        static_cast<std::uint32_t>(channel.target), channel.index, channel.width,
                        static_cast<std::uint32_t>(channel.interpolation), 0});
  return channels;
}

}  // namespace

sunder_transform transform_of(const BoneTransform& transform) {
  sunder_transform out;
  for (int i = 0; i < 3; ++i) out.translation[i] = transform.translation[i];
  for (int i = 0; i < 4; ++i) out.rotation[i] = transform.rotation.coeffs()[i];
  for (int i = 0; i < 3; ++i) out.scale[i] = transform.scale[i];
  return out;
}

BoneTransform transform_of(const sunder_transform& transform) {
  return {Vec3f(transform.translation), Quatf(transform.rotation), Vec3f(transform.scale)};
}

void MeshView::set(const Mesh& mesh) {
  uv_sets_.clear();
  for (const auto& set : mesh.uv_sets) uv_sets_.push_back(numbers_of(set));
  color_sets_.clear();
  for (const auto& set : mesh.color_sets) color_sets_.push_back(numbers_of(set));
  attributes_.clear();
  for (const CustomAttribute& one : mesh.custom_attributes)
    attributes_.push_back(
        {one.name.c_str(), one.values.data(), one.components, one.interpolates ? 0u : 1u});
  morph_targets_.clear();
  for (const MorphTarget& target : mesh.morph_targets)
    morph_targets_.push_back({target.name.c_str(), numbers_of(target.position_deltas),
                              numbers_of(target.normal_deltas), numbers_of(target.tangent_deltas)});
  submeshes_.clear();
  for (const Submesh& submesh : mesh.submeshes)
    submeshes_.push_back({submesh.name.c_str(), submesh.material, 0});

  view_ = {};
  view_.name = mesh.name.c_str();
  view_.positions = numbers_of(mesh.positions);
  view_.normals = numbers_of(mesh.normals);
  view_.tangents = numbers_of(mesh.tangents);
  view_.uv_sets = or_null(uv_sets_);
  view_.color_sets = or_null(color_sets_);
  view_.attributes = or_null(attributes_);
  view_.first_influence = mesh.weights.first.data();
  view_.influences = reinterpret_cast<const sunder_influence*>(or_null(mesh.weights.influences));
  view_.morph_targets = or_null(morph_targets_);
  view_.triangles = mesh.triangles.empty() ? nullptr : mesh.triangles.front().data();
  view_.triangle_submesh = or_null(mesh.triangle_submesh);
  view_.submeshes = or_null(submeshes_);
  view_.skin = mesh.skin;
  view_.vertex_count = mesh.vertex_count();
  view_.triangle_count = mesh.triangle_count();
  view_.uv_set_count = count_of(uv_sets_);
  view_.color_set_count = count_of(color_sets_);
  view_.attribute_count = count_of(attributes_);
  view_.morph_target_count = count_of(morph_targets_);
  view_.first_morph_weight = mesh.first_morph_weight;
  view_.submesh_count = count_of(submeshes_);
}

CharacterView::CharacterView(const Character& character)
    : bones(bones_of(character.skeleton)),
      skins(skins_of(character)),
      mesh_views(character.meshes.size()) {
  for (std::size_t m = 0; m < mesh_views.size(); ++m) {
    mesh_views[m].set(character.meshes[m]);
    meshes.push_back(mesh_views[m].get());
  }
  for (const Clip& clip : character.clips) channels.push_back(channels_of(clip));
  for (std::size_t i = 0; i < channels.size(); ++i)
    clips.push_back({character.clips[i].name.c_str(), or_null(channels[i]), count_of(channels[i]),
                     character.clips[i].duration});
  data.struct_size = sizeof data;
  data.bone_count = count_of(bones);
  data.skin_count = count_of(skins);
  data.mesh_count = count_of(meshes);
  data.clip_count = count_of(clips);
  data.morph_weight_count = count_of(character.rest_morph_weights);
  data.name = character.name.c_str();
  data.bones = or_null(bones);
  data.skins = or_null(skins);
  data.meshes = or_null(meshes);
  data.clips = or_null(clips);
  data.rest_morph_weights = or_null(character.rest_morph_weights);
}

}  // namespace sunder::c
