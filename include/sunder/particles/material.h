#pragma once

#include <sunder/core/api.h>
#include <sunder/core/status.h>

#include <span>
#include <string>
#include <string_view>

namespace sunder {

/// The mechanical properties of a particle. Stiffnesses are per mass: newtons per metre, for one
/// kilogram.
struct SoftMaterial {
  std::string name;
  /// Stiffness of the spring that returns a particle to its rest position, 1/s^2. Its square root
  /// is the frequency in radians per second. [0, 1e12].
  double return_stiffness = 400.0;
  /// Damping ratio of that spring and of the springs to neighbours; 1 is critical. [0, 1e6].
  double damping_ratio = 0.7;
  double neighbour_stiffness = 400.0;  ///< 1/s^2, times ParticleSet::coupling(). [0, 1e12].
  double mass = 0.01;                  ///< Kilograms per particle. [1e-12, 1e12].
  /// Suggested DecompositionOptions::range, a fraction of the diagonal. (0, 1].
  double range = 0.1;
  /// Limit for the distance of two neighbours, relative to rest; >= 1, or 0: none.
  double stretch_limit = 0.0;
  double strength = 0.0;  ///< Stretch at which the tissue tears; > 1, or 0: it never does.

  bool operator==(const SoftMaterial&) const = default;
};

/// Checks that all values are finite and within their ranges.
/// @return non_finite_value or invalid_argument; the text names the material and the field.
///         Thread-safe.
[[nodiscard]] SUNDER_API Status validate_material(const SoftMaterial& material);

/// Presets: "skin", "fat", "muscle", "rubber", "sponge", "jelly". Thread-safe.
[[nodiscard]] SUNDER_API std::span<const SoftMaterial> material_presets();

/// A preset by its name. @return not_found. Thread-safe.
[[nodiscard]] SUNDER_API Result<SoftMaterial> find_material(std::string_view name);

}  // namespace sunder
