#include <sunder/core/memory_scope.h>
#include <sunder/scene/character_asset.h>
#include <sunder/skinning/pose.h>

#include <cmath>
#include <new>

#include "core/internal/out_of_memory.h"
#include "scene/asset_data.h"

namespace sunder {
namespace {

Result<scene::AssetMesh> make_mesh(const Mesh& mesh, std::size_t slots,
                                   const CharacterAssetOptions& options) {
  Result<SkinnedMesh> skinned = SkinnedMesh::create(source_of(mesh), slots);
  if (!skinned) return skinned.error();
  return scene::AssetMesh{std::move(*skinned),
                          slots,
                          scene::DrawOrder(mesh),
                          options.poses_vertices,
                          options.has_normals && !mesh.normals.empty(),
                          options.has_tangents && !mesh.tangents.empty()};
}

/// Whether a coarser level of detail follows the same poses.
Status check_coarser(const Character& character, const Character& coarser) {
  const std::vector<Bone>& bones = character.skeleton.bones;
  const std::vector<Bone>& of_coarser = coarser.skeleton.bones;
  if (of_coarser.size() != bones.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the coarser level has %zu bones; the character has %zu",
                           of_coarser.size(), bones.size());
  if (coarser.rest_morph_weights.size() != character.rest_morph_weights.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the coarser level has %zu morph weights; the character has %zu",
                           coarser.rest_morph_weights.size(), character.rest_morph_weights.size());
  for (Index bone = 0; bone < bones.size(); ++bone)
    if (of_coarser[bone].name != bones[bone].name || of_coarser[bone].parent != bones[bone].parent)
      return Status::failure(
          StatusCode::not_found, bone,
          "bone %u is '%.60s' in the coarser level, and '%.60s' in the character", bone,
          of_coarser[bone].name.c_str(), bones[bone].name.c_str());
  return {};
}

/// Divides the surface into particles, and makes the tissue that instances copy.
Status divide(const SoftTissue& soft, scene::AssetData& data) {
  Result<TornModel> model = TornModel::create(data.torn);
  if (!model) return model.error();
  // At rest lengths are metres; bind space may have any unit, such as that of quantised positions.
  const Result<ModelPose> rest = rest_pose(*data.character);
  if (!rest) return rest.error();
  auto particles = ParticleAsset::create(*model, *rest, soft.decomposition, soft.authored);
  if (!particles) return particles.error();
  data.particles = std::move(*particles);
  Result<scene::TissueAtRest> tissue = scene::make_tissue(soft, *model, data.particles);
  if (!tissue) return tissue.error();
  data.tissue = std::move(*tissue);
  return {};
}

}  // namespace

CharacterAsset::CharacterAsset(std::unique_ptr<const scene::AssetData> data)
    : data_(std::move(data)) {}
CharacterAsset::~CharacterAsset() = default;

Result<std::shared_ptr<const CharacterAsset>> CharacterAsset::create(
    std::shared_ptr<const Character> character, const CharacterAssetOptions& options) {
  if (!character) return Status::failure(StatusCode::empty_input, kNone, "there is no character");
  const MemoryScope scope(options.memory != nullptr ? options.memory : MemoryScope::current());
  try {
    auto torn = TornAsset::create(character);
    if (!torn) return torn.error();
    if (!(std::isfinite(options.coarser_below) && options.coarser_below >= 0))
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "coarser_below is %g pixels; it must be finite and not negative",
                             options.coarser_below);
    if (options.coarser)
      if (Status status = check_coarser(*character, *options.coarser->character()); !status)
        return status;
    auto data = std::make_unique<scene::AssetData>();
    data->options = options;
    for (const Mesh& mesh : character->meshes) {
      auto made = make_mesh(mesh, character->skins[mesh.skin].bones.size(), options);
      if (!made) return made.error();
      data->meshes.push_back(std::move(*made));
    }
    data->character = std::move(character);
    data->torn = std::move(*torn);
    if (options.soft)
      if (Status status = divide(*options.soft, *data); !status) return status;
    return std::shared_ptr<const CharacterAsset>(new CharacterAsset(std::move(data)));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

const std::shared_ptr<const Character>& CharacterAsset::character() const {
  return data_->character;
}
const CharacterAssetOptions& CharacterAsset::options() const { return data_->options; }

std::span<const Triangle> CharacterAsset::triangles(std::uint32_t mesh) const {
  SUNDER_ASSERT(mesh < data_->meshes.size());
  return data_->meshes[mesh].order.triangles(data_->character->meshes[mesh]);
}

std::span<const DrawRange> CharacterAsset::draw_ranges(std::uint32_t mesh) const {
  SUNDER_ASSERT(mesh < data_->meshes.size());
  return data_->meshes[mesh].order.ranges();
}

std::size_t CharacterAsset::memory_bytes() const {
  const TornMemory torn = data_->torn->memory_bytes();
  std::size_t bytes = sizeof(*this) + sizeof(*data_) + torn.shared + torn.reserved;
  if (data_->particles)
    bytes += data_->particles->memory_bytes() + data_->tissue->particles->memory_bytes() +
             data_->tissue->body.memory_bytes();
  for (const scene::AssetMesh& mesh : data_->meshes)
    bytes += sizeof(mesh) + mesh.skinned.stream_bytes() + mesh.order.memory_bytes();
  return bytes;
}

}  // namespace sunder
