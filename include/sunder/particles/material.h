#pragma once

#include <sunder/core/api.h>
#include <sunder/core/status.h>

#include <span>
#include <string>
#include <string_view>

namespace sunder {

/// What a particle is made of. Stiffnesses are by mass: newtons a metre, for a kilogram.
struct SoftMaterial {
  std::string name;
  double return_stiffness = 400.0;     ///< 1/s^2, of the spring to the posed rest; its root is radians a second. [0, 1e12].
  double damping_ratio = 0.7;          ///< Of that spring and of those to neighbours; 1: critical. [0, 1e6].
  double neighbour_stiffness = 400.0;  ///< 1/s^2, times ParticleSet::coupling(). [0, 1e12].
  double mass = 0.01;                  ///< Kilograms a particle. [1e-12, 1e12].
  double range = 0.1;                  ///< Of a particle: for DecompositionOptions, a fraction of the model's diagonal. (0, 1].
  double stretch_limit = 0.0;          ///< Distance of two neighbours over that at rest, at most; >= 1, or 0: any.
  double strength = 0.0;               ///< Stretch at which the tissue tears; > 1, or 0: it never does.

  bool operator==(const SoftMaterial&) const = default;
};

/// @return non_finite_value or invalid_argument, which name the material and the field.
[[nodiscard]] SUNDER_API Status validate_material(const SoftMaterial& material);

/// Ready for use, to begin with: "skin", "fat", "muscle", "rubber", "sponge", "jelly".
[[nodiscard]] SUNDER_API std::span<const SoftMaterial> material_presets();

/// One of those. @return not_found.
[[nodiscard]] SUNDER_API Result<SoftMaterial> find_material(std::string_view name);

}  // namespace sunder
