#include <utility>

#include "bindings/c/numbers.h"
#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

sunder_wound_mask_options mask_defaults() {
  const WoundMaskOptions from;
  sunder_wound_mask_options to = {};
  to.struct_size = sizeof to;
  to.width = from.width;
  to.height = from.height;
  to.uv_set = from.uv_set;
  to.dilation = from.dilation;
  to.reach = from.reach;
  to.first_operation = from.first_operation;
  to.operation_count = from.operation_count;
  return to;
}

sunder_blood_flow_options flow_defaults() {
  const BloodFlowOptions from;
  sunder_blood_flow_options to = {};
  to.struct_size = sizeof to;
  for (int i = 0; i < 3; ++i) to.down[i] = from.down[i];
  to.length = from.length;
  to.width = from.width;
  to.spacing = from.spacing;
  to.seed = from.seed;
  return to;
}

/// Gives the caller a view of numbers per texel.
/// @param compute  compute(mask of the mesh, instance) -> Result<std::vector<float>>
template <class Compute>
sunder_status give_texels(const Found& found, std::uint32_t mesh, const float** texels,
                          std::uint32_t* texel_count, Compute compute) {
  if (texels == nullptr) return null_pointer("texels");
  if (texel_count == nullptr) return null_pointer("texel_count");
  const auto painted = found.instance->peek_wound_mask(mesh);
  if (!painted) return report(painted.error());
  Result<std::vector<float>> computed = compute(**painted, *found.instance);
  if (!computed) return report(computed.error());
  found.scene->texels = std::move(*computed);
  *texels = found.scene->texels.data();
  *texel_count = count_of(found.scene->texels);
  return SUNDER_OK;
}

sunder_wound_mask view_of(const CharacterInstance::PaintedWounds& painted) {
  const WoundMask& mask = *painted.mask;
  sunder_wound_mask to = {};
  to.struct_size = sizeof to;
  to.width = mask.options().width;
  to.height = mask.options().height;
  to.left = painted.changed.left;
  to.top = painted.changed.top;
  to.changed_width = painted.changed.width;
  to.changed_height = painted.changed.height;
  to.overlapping_texels = mask.notes().overlapping_texels;
  to.unpainted_triangles = mask.notes().unpainted_triangles;
  to.distances = mask.distances().data();
  return to;
}

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_wound_mask_options sunder_default_wound_mask_options(void) { return mask_defaults(); }

sunder_status sunder_begin_wound_mask(sunder_scene scene, sunder_instance instance, uint32_t mesh,
                                      const sunder_wound_mask_options* options) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_mesh(scene, instance, mesh, found));
    SUNDER_C_TRY(check_options(options, "options"));
    const sunder_wound_mask_options from = options != nullptr ? *options : mask_defaults();
    sunder::WoundMaskOptions to;
    to.width = from.width;
    to.height = from.height;
    to.uv_set = from.uv_set;
    to.dilation = from.dilation;
    to.reach = from.reach;
    to.first_operation = from.first_operation;
    to.operation_count = from.operation_count;
    return report(found.instance->begin_wound_mask(mesh, to));
  });
}

sunder_status sunder_get_wound_mask(sunder_scene scene, sunder_instance instance, uint32_t mesh,
                                    sunder_wound_mask* mask) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_mesh(scene, instance, mesh, found));
    SUNDER_C_TRY(check_struct(mask, "mask"));
    const auto painted = found.instance->wound_mask(mesh);
    if (!painted) return report(painted.error());
    *mask = view_of(*painted);
    return SUNDER_OK;
  });
}

sunder_status sunder_get_wound_channel(sunder_scene scene, sunder_instance instance, uint32_t mesh,
                                       uint32_t channel, const float** texels,
                                       uint32_t* texel_count) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_mesh(scene, instance, mesh, found));
    SUNDER_C_TRY(check_enum(channel, SUNDER_WOUND_STRETCH, "channel"));
    return give_texels(found, mesh, texels, texel_count,
                       [&](const sunder::WoundMask& mask, sunder::CharacterInstance& of) {
                         if (channel == SUNDER_WOUND_STRETCH)
                           return mask.stretches(*of.model(), of.mesh(mesh).positions);
                         return mask.channel(*of.model(), channel == SUNDER_WOUND_AGE
                                                              ? sunder::WoundChannel::age
                                                              : sunder::WoundChannel::depth);
                       });
  });
}

sunder_blood_flow_options sunder_default_blood_flow_options(void) { return flow_defaults(); }

sunder_status sunder_flow_blood(sunder_scene scene, sunder_instance instance, uint32_t mesh,
                                const sunder_blood_flow_options* options, const float** texels,
                                uint32_t* texel_count) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_mesh(scene, instance, mesh, found));
    SUNDER_C_TRY(check_options(options, "options"));
    const sunder_blood_flow_options from = options != nullptr ? *options : flow_defaults();
    sunder::BloodFlowOptions to;
    to.down = {from.down[0], from.down[1], from.down[2]};
    to.length = from.length;
    to.width = from.width;
    to.spacing = from.spacing;
    to.seed = from.seed;
    return give_texels(found, mesh, texels, texel_count,
                       [&](const sunder::WoundMask& mask, sunder::CharacterInstance& of) {
                         return mask.flow(*of.model(), of.pose(), to);
                       });
  });
}

sunder_status sunder_end_wound_mask(sunder_scene scene, sunder_instance instance, uint32_t mesh) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_mesh(scene, instance, mesh, found));
    found.instance->end_wound_mask(mesh);
    return SUNDER_OK;
  });
}

}  // extern "C"
