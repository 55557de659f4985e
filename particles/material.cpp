#include <sunder/particles/material.h>

#include <array>
#include <cmath>

#include "particles/internal/angular_frequency.h"
#include "particles/motion/slit_gap.h"

namespace sunder {
namespace {

struct Field {
  const char* name;
  double value, least, most;
};

Status check_argument(const Field& of) {
  if (!std::isfinite(of.value))
    return Status::failure(StatusCode::non_finite_value, kNone, "%s is not finite", of.name);
  if (of.value < of.least || of.value > of.most)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "%s is %g; it must be from %g to %g", of.name, of.value, of.least,
                           of.most);
  return {};
}

/// The gap of a wound per tension, m^2/N.
Result<double> gap_per_tension(const SoftMaterial& material, double wound_length) {
  if (const Status status = validate_material(material); !status) return status;
  const std::array fields = {
      Field{"membrane_stiffness", material.membrane_stiffness, 1e-12, 1e12},
      Field{"wound_length", wound_length, 1e-12, 1e12},
  };
  for (const Field& field : fields)
    if (const Status status = check_argument(field); !status) return status;
  const double stiffness = material.membrane_stiffness,
               foundation =
                   material.areal_density * particles::squared_frequency(material.return_frequency);
  const double half_length = 0.5 * wound_length * std::sqrt(foundation / stiffness);
  // Without a foundation, or next to none, the gap is an ellipse.
  const double ratio = half_length > 1e-12 ? particles::slit_gap(half_length) / half_length : 1;
  return ratio * wound_length / stiffness;
}

/// A preset whose slits run on at the gap at which those of the real tissue do.
/// @param toughness_by_modulus  of the real tissue: J/m^2 by N/m^2, metres.
SoftMaterial preset(SoftMaterial material, double toughness_by_modulus) {
  material.toughness = 2 * material.membrane_stiffness * toughness_by_modulus;
  return material;
}

}  // namespace

Status validate_material(const SoftMaterial& material) {
  const std::array fields = {
      Field{"return_frequency", material.return_frequency, 0.0, 1.6e5},
      Field{"damping_ratio", material.damping_ratio, 0.0, 1e6},
      Field{"membrane_stiffness", material.membrane_stiffness, 0.0, 1e12},
      Field{"membrane_damping", material.membrane_damping, 0.0, 1e12},
      Field{"areal_density", material.areal_density, 1e-12, 1e12},
      Field{"range", material.range, 1e-6, 1.0},
      Field{"stretch_limit", material.stretch_limit == 0 ? 1.0 : material.stretch_limit, 1.0, 1e6},
      Field{"strength", material.strength == 0 ? 2.0 : material.strength, std::nextafter(1.0, 2.0),
            1e6},
      Field{"toughness", material.toughness, 0.0, 1e12},
      Field{"flaw_length", material.flaw_length, 1e-9, 1e12},
      Field{"yield_stretch", material.yield_stretch == 0 ? 2.0 : material.yield_stretch,
            std::nextafter(1.0, 2.0), 1e6},
      Field{"plastic_limit", material.plastic_limit, 0.0, 1e3},
  };
  for (const Field& field : fields) {
    if (!std::isfinite(field.value))
      return Status::failure(StatusCode::non_finite_value, kNone,
                             "material '%.64s': %s is not finite", material.name.c_str(),
                             field.name);
    if (field.value < field.least || field.value > field.most)
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "material '%.64s': %s is %g; it must be from %g to %g%s",
                             material.name.c_str(), field.name, field.value, field.least,
                             field.most, field.least == 1.0 ? ", or 0" : "");
  }
  return {};
}

std::span<const SoftMaterial> material_presets() {
  // docs/particles.md has the source of each value, and says which are chosen for their look.
  static const std::array presets = {
      preset({"skin", 3.2, 0.7, 9, 0.6, 1109 * 0.4e-3, 0.08, 1.6, 1.54}, 17e3 / 0.42e6),
      preset({"fat", 1.5, 0.35, 3, 0.2, 911 * 0.8e-3, 0.12, 0, 2.2}, 0.2),
      preset({"muscle", 4.8, 0.8, 32, 1.7, 1090 * 0.8e-3, 0.1, 1.4, 1.35}, 550 / 22e3),
      preset({"liver", 2.0, 0.5, 3, 0.2, 1079 * 0.8e-3, 0.1, 0, 1.4}, 164 / 5.5e3),
      preset({"rubber", 4.8, 0.15, 25, 0.25, 950 * 0.4e-3, 0.1, 3.0, 2.8}, 3e3 / (3 * 0.39e6)),
      preset({"foam", 1.95, 1.0, 1.5, 0.25, 250 * 0.8e-3, 0.12, 0, 1.5}, 0.01),
      preset({"cloth", 1.0, 0.4, 0.7, 0.03, 0.2, 0.1, 1.15, 1.12}, 0.006),
      preset({"jelly", 1.23, 0.1, 5, 0.13, 1000 * 0.8e-3, 0.15, 0, 1.7}, 0.02),
  };
  return presets;
}

Result<SoftMaterial> find_material(std::string_view name) {
  for (const SoftMaterial& material : material_presets())
    if (material.name == name) return material;
  return Status::failure(StatusCode::not_found, kNone, "there is no material '%.*s'",
                         static_cast<int>(std::min<std::size_t>(name.size(), 64)), name.data());
}

Result<double> gap_under_tension(const SoftMaterial& material, double wound_length,
                                 double tension) {
  const Result<double> gap = gap_per_tension(material, wound_length);
  if (!gap) return gap;
  if (const Status status = check_argument({"tension", tension, 0.0, 1e12}); !status) return status;
  return tension * *gap;
}

Result<double> tension_for_gap(const SoftMaterial& material, double wound_length, double gap) {
  const Result<double> per_tension = gap_per_tension(material, wound_length);
  if (!per_tension) return per_tension;
  if (const Status status = check_argument({"gap", gap, 0.0, 1e12}); !status) return status;
  return gap / *per_tension;
}

}  // namespace sunder
