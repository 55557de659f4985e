#include "bindings/c/asset.h"

#include <array>
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

sunder_status read_field(const sunder_tissue_field& from, AuthoredTissue& tissue) {
  SUNDER_C_TRY(check_struct(&from, "fields[]"));
  SUNDER_C_TRY(check_enum(from.field, SUNDER_FIELD_THICKNESS, "field"));
  if (from.values == nullptr) return null_pointer("fields[].values");
  if (from.mesh >= tissue.meshes.size())
    return fail(SUNDER_INDEX_OUT_OF_RANGE, from.mesh,
                "`fields[].mesh` is %u; the character has %zu meshes", from.mesh,
                tissue.meshes.size());
  constexpr std::array fields = {&TissueFactors::strength, &TissueFactors::toughness,
                                 &TissueFactors::stiffness, &TissueFactors::tension,
                                 &TissueFactors::thickness};
  (tissue.meshes[from.mesh].*fields[from.field])
      .assign(from.values, from.values + from.value_count);
  return SUNDER_OK;
}

sunder_status read_perforation(const sunder_perforation& from, AuthoredTissue& tissue) {
  SUNDER_C_TRY(check_struct(&from, "perforations[]"));
  if (from.places == nullptr) return null_pointer("perforations[].places");
  Perforation& made = tissue.perforations.emplace_back();
  made.strength = from.strength;
  for (std::uint32_t i = 0; i < from.place_count; ++i) {
    const sunder_surface_place& at = from.places[i];
    made.line.push_back(
        {at.mesh, at.triangle, {at.barycentric[0], at.barycentric[1], at.barycentric[2]}});
  }
  return SUNDER_OK;
}

sunder_status read_authored(const sunder_asset_options& from, std::size_t mesh_count,
                            AuthoredTissue& tissue) {
  if (from.field_count > 0 && from.fields == nullptr) return null_pointer("fields");
  if (from.perforation_count > 0 && from.perforations == nullptr)
    return null_pointer("perforations");
  if (from.field_count > 0) tissue.meshes.resize(mesh_count);
  for (std::uint32_t i = 0; i < from.field_count; ++i)
    SUNDER_C_TRY(read_field(from.fields[i], tissue));
  for (std::uint32_t i = 0; i < from.perforation_count; ++i)
    SUNDER_C_TRY(read_perforation(from.perforations[i], tissue));
  return SUNDER_OK;
}

/// @return a failure of a material.
sunder_status read_tissue(const sunder_asset_options& from, std::size_t mesh_count,
                          SoftTissue& tissue) {
  SUNDER_C_TRY(read_authored(from, mesh_count, tissue.authored));
  tissue.body.self_contact = {from.self_contact_thickness, from.self_contact_friction};
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

sunder_status read_options(const sunder_asset_options& from, std::size_t mesh_count,
                           CharacterAssetOptions& options) {
  if (from.is_soft != 0) SUNDER_C_TRY(read_tissue(from, mesh_count, options.soft.emplace()));
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
    if (options != nullptr)
      SUNDER_C_TRY(read_options(*options, object->parts->loaded.character->meshes.size(), wanted));
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
