#include "scene/snapshot/asset_digest.h"

#include "core/internal/digest.h"

namespace sunder::scene {
namespace {

void add(const Mesh& mesh, Digest& digest) {
  digest.add(mesh.skin);
  digest.add(mesh.positions);
  digest.add(mesh.weights.first);
  digest.add(mesh.weights.influences);
  digest.add(mesh.triangles);
  digest.add(mesh.triangle_submesh);
  digest.add(mesh.first_morph_weight);
  for (const MorphTarget& target : mesh.morph_targets) digest.add(target.position_deltas);
}

void add(const Bone& bone, Digest& digest) {
  digest.add(bone.parent);
  digest.add(bone.rest.translation);
  for (int i = 0; i < 4; ++i) digest.add(bone.rest.rotation.coeffs()[i]);
  digest.add(bone.rest.scale);
}

void add(const Clip& clip, Digest& digest) {
  for (const Channel& channel : clip.channels) {
    digest.add(static_cast<std::uint32_t>(channel.target));
    digest.add(channel.index);
    digest.add(static_cast<std::uint32_t>(channel.interpolation));
    digest.add(channel.times);
    digest.add(channel.values);
  }
}

void add(const Character& character, Digest& digest) {
  for (const Bone& bone : character.skeleton.bones) add(bone, digest);
  for (const Skin& skin : character.skins) {
    digest.add(skin.bones);
    for (const Affine3f& bind : skin.bone_from_bind)
      for (int i = 0; i < 12; ++i) digest.add(bind.data()[i]);
  }
  for (const Mesh& mesh : character.meshes) add(mesh, digest);
  digest.add(character.rest_morph_weights);
  for (const Clip& clip : character.clips) add(clip, digest);
}

void add(const DecompositionOptions& options, Digest& digest) {
  digest.add(options.range);
  digest.add(static_cast<std::uint32_t>(options.is_fraction));
  digest.add(options.seed);
}

void add(const AuthoredTissue& tissue, Digest& digest) {
  for (const TissueFactors& of : tissue.meshes)
    for (const auto* field :
         {&of.strength, &of.toughness, &of.stiffness, &of.tension, &of.thickness})
      digest.add(*field);
  for (const Perforation& perforation : tissue.perforations) {
    digest.add(perforation.strength);
    for (const TissuePlace& place : perforation.line) {
      digest.add(place.mesh);
      digest.add(place.triangle);
      for (const double part : place.barycentric) digest.add(part);
    }
  }
}

}  // namespace

std::uint64_t digest_of(const CharacterAsset& asset) {
  Digest digest;
  add(*asset.character(), digest);
  const CharacterAssetOptions& options = asset.options();
  if (options.soft) {
    add(options.soft->decomposition, digest);
    add(options.soft->authored, digest);
  }
  if (options.coarser) digest.add(digest_of(*options.coarser));
  return digest.value();
}

}  // namespace sunder::scene
