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
  return to;
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

sunder_status sunder_end_wound_mask(sunder_scene scene, sunder_instance instance, uint32_t mesh) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_mesh(scene, instance, mesh, found));
    found.instance->end_wound_mask(mesh);
    return SUNDER_OK;
  });
}

}  // extern "C"
