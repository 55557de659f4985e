#include "bindings/c/asset.h"

#include <utility>

#include "bindings/c/structs.h"

namespace sunder::c {

static_assert(sizeof(DrawRange) == sizeof(sunder_draw_range));

Result<std::optional<WeightOptions>> weights_of(std::int32_t policy,
                                                std::uint32_t maximum_influences) {
  if (policy == SUNDER_WEIGHTS_OF_MODEL) return std::optional<WeightOptions>();
  if (policy < SUNDER_WEIGHTS_BARYCENTRIC || policy > SUNDER_WEIGHTS_EXACT)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "`weight_policy` is %d; expected -1 to 3", policy);
  return std::optional<WeightOptions>({static_cast<WeightPolicy>(policy), maximum_influences});
}

namespace {

/// @return a failure of a material.
sunder_status read_tissue(const sunder_asset_options& from, SoftTissue& tissue) {
  if (from.material_count > 0) {
    if (from.materials == nullptr) return null_pointer("materials");
    tissue.materials.clear();
    for (std::uint32_t i = 0; i < from.material_count; ++i) {
      SUNDER_C_TRY(check_struct(&from.materials[i], "materials[]"));
      tissue.materials.push_back(material_of(from.materials[i]));
    }
  }
  tissue.decomposition.range =
      from.particle_range != 0.0 ? from.particle_range : tissue.materials.front().range;
  tissue.decomposition.seed = from.particle_seed;
  tissue.gravity = Vec3d(from.gravity);
  tissue.tension.newtons_per_metre = from.tension;
  tissue.tension.adds_pose_strain = from.adds_pose_strain != 0;
  return SUNDER_OK;
}

sunder_status read_options(const sunder_asset_options& from, CharacterAssetOptions& options) {
  if (from.is_soft != 0) SUNDER_C_TRY(read_tissue(from, options.soft.emplace()));
  const auto weights = weights_of(from.weight_policy, from.maximum_influences);
  if (!weights) return report(weights.error());
  if (*weights) options.weights = **weights;
  SUNDER_C_TRY(check_enum(from.skinning, SUNDER_SKIN_DUAL_QUATERNION, "skinning"));
  options.poses_vertices = from.poses_vertices != 0;
  options.method = static_cast<SkinningMethod>(from.skinning);
  options.has_normals = from.has_normals != 0;
  options.has_tangents = from.has_tangents != 0;
  options.unit_length = from.unit_length != 0;
  options.coarser_below = from.coarser_below;
  if (from.coarser == 0) return SUNDER_OK;
  const AssetObject* const coarser = find<AssetObject>(from.coarser);
  if (coarser == nullptr) return SUNDER_INVALID_HANDLE;
  options.coarser = coarser->parts->asset;
  return SUNDER_OK;
}

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_asset_options sunder_default_asset_options(void) {
  const sunder::CharacterAssetOptions defaults;
  sunder_asset_options options = {};
  options.struct_size = sizeof options;
  options.poses_vertices = defaults.poses_vertices ? 1 : 0;
  options.has_normals = defaults.has_normals ? 1 : 0;
  options.has_tangents = defaults.has_tangents ? 1 : 0;
  options.unit_length = defaults.unit_length ? 1 : 0;
  return options;
}

sunder_status sunder_create_asset(sunder_character character, const sunder_asset_options* options,
                                  sunder_asset* asset) {
  return guarded([&]() -> sunder_status {
    const CharacterObject* const object = find<CharacterObject>(character);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    SUNDER_C_TRY(check_options(options, "options"));
    if (asset == nullptr) return null_pointer("asset");
    sunder::CharacterAssetOptions wanted;
    if (options != nullptr) SUNDER_C_TRY(read_options(*options, wanted));
    auto created = sunder::CharacterAsset::create(object->parts->loaded.character, wanted);
    if (!created) return report(created.error());
    auto added = std::make_unique<AssetObject>();
    added->parts =
        std::make_shared<const AssetParts>(AssetParts{std::move(*created), object->parts});
    return add(std::move(added), asset);
  });
}

sunder_status sunder_destroy_asset(sunder_asset asset) {
  return destroy_object(asset, Kind::asset);
}

sunder_status sunder_get_asset_triangles(sunder_asset asset, uint32_t mesh,
                                         const uint32_t** triangles, uint32_t* triangle_count,
                                         const sunder_draw_range** ranges, uint32_t* range_count) {
  const AssetObject* const object = find<AssetObject>(asset);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  if (triangles == nullptr) return null_pointer("triangles");
  if (triangle_count == nullptr) return null_pointer("triangle_count");
  if (ranges == nullptr) return null_pointer("ranges");
  if (range_count == nullptr) return null_pointer("range_count");
  const sunder::CharacterAsset& of = *object->parts->asset;
  if (mesh >= of.character()->meshes.size())
    return fail(SUNDER_INDEX_OUT_OF_RANGE, mesh, "mesh %u of %zu", mesh,
                of.character()->meshes.size());
  const auto all = of.triangles(mesh);
  const auto draw = of.draw_ranges(mesh);
  *triangles = all.empty() ? nullptr : all.front().data();
  *triangle_count = static_cast<uint32_t>(all.size());
  *ranges = reinterpret_cast<const sunder_draw_range*>(draw.data());
  *range_count = static_cast<uint32_t>(draw.size());
  return SUNDER_OK;
}

}  // extern "C"
