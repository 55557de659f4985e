#include <sunder/particles/material.h>

#include "bindings/c/asset.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

/// Copies all fields that both kinds of material have.
template <class From, class To>
void copy_fields(const From& from, To& to) {
  to.return_frequency = from.return_frequency;
  to.damping_ratio = from.damping_ratio;
  to.membrane_stiffness = from.membrane_stiffness;
  to.membrane_damping = from.membrane_damping;
  to.areal_density = from.areal_density;
  to.range = from.range;
  to.stretch_limit = from.stretch_limit;
  to.strength = from.strength;
  to.toughness = from.toughness;
  to.flaw_length = from.flaw_length;
  to.yield_stretch = from.yield_stretch;
  to.plastic_limit = from.plastic_limit;
}

sunder_material material_of(const SoftMaterial& from) {
  sunder_material to = {};
  to.struct_size = sizeof to;
  copy_fields(from, to);
  return to;
}

}  // namespace

SoftMaterial material_of(const sunder_material& from) {
  SoftMaterial to;
  copy_fields(from, to);
  return to;
}

}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_material sunder_default_material(void) { return material_of(sunder::SoftMaterial()); }

sunder_status sunder_find_material(const char* name, sunder_material* material) {
  return guarded([&]() -> sunder_status {
    if (name == nullptr) return null_pointer("name");
    SUNDER_C_TRY(check_struct(material, "material"));
    const auto found = sunder::find_material(name);
    if (!found) return report(found.error());
    *material = material_of(*found);
    return SUNDER_OK;
  });
}

sunder_status sunder_tension_for_gap(const sunder_material* material, double length, double gap,
                                     double* tension) {
  return guarded([&]() -> sunder_status {
    SUNDER_C_TRY(check_struct(material, "material"));
    if (tension == nullptr) return null_pointer("tension");
    const auto found = sunder::tension_for_gap(material_of(*material), length, gap);
    if (!found) return report(found.error());
    *tension = *found;
    return SUNDER_OK;
  });
}

}  // extern "C"
