#pragma once

#include <sunder/core/api.h>
#include <sunder/core/status.h>

#include <span>
#include <string>
#include <string_view>

namespace sunder {

/// The mechanical properties of tissue: a membrane on an elastic foundation, which returns it to
/// the pose. They are independent of how the surface is divided into particles. The displacement u
/// of the tissue obeys
///
///   rho u'' = S div grad u + D div grad u' - rho (k u + 2 zeta sqrt(k) u') + force per area
///
/// so a point force or a wound moves the tissue within a distance of about sqrt(S / (rho k)).
struct SoftMaterial {
  std::string name;
  /// Frequency with which tissue swings as a whole, without damping, hertz. It gives the stiffness
  /// of the foundation by mass: k = (2 pi frequency)^2. [0, 1.6e5].
  double return_frequency = 3.2;
  /// zeta: damping ratio of the foundation; 1 is critical. [0, 1e6].
  double damping_ratio = 0.7;
  double membrane_stiffness = 4.0;  ///< S, N/m. [0, 1e12].
  double membrane_damping = 0.25;   ///< D, N s/m. [0, 1e12].
  double areal_density = 0.4;       ///< rho, kg/m^2: density times thickness. [1e-12, 1e12].
  /// Suggested DecompositionOptions::range, a fraction of the diagonal. (0, 1].
  double range = 0.1;
  /// Limit for the distance of two neighbours, relative to rest; >= 1, or 0: none.
  double stretch_limit = 0.0;
  /// Stretch of the surface by its displacement at which the tissue begins to tear; > 1, or 0: it
  /// never does. Nor does it where stretch_limit is less.
  double strength = 0.0;
  /// Energy that a tear takes per metre of its length, J/m: joules per square metre times
  /// thickness. A tip runs on where the tissue releases at least this. 0: see flaw_length.
  /// [0, 1e12].
  double toughness = 0.0;
  /// For tissue with a strength and without a toughness: a slit of this length runs on at the
  /// strength, which takes pi S (strength - 1)^2 flaw_length / 4 per metre. Metres. [1e-9, 1e12].
  double flaw_length = 0.02;
  /// Plasticity: stretch beyond which tissue keeps what it was stretched further; > 1, or 0: it
  /// always returns. Measured without shrinking, as the root of the squared gradient of the
  /// displacement, so turning counts too, as for the membrane.
  double yield_stretch = 0.0;
  double plastic_limit = 0.5;  ///< Greatest strain that it keeps. [0, 1e3].

  bool operator==(const SoftMaterial&) const = default;
};

/// Checks that all values are finite and within their ranges.
/// @return non_finite_value or invalid_argument; the text names the material and the field.
///         Thread-safe.
[[nodiscard]] SUNDER_API Status validate_material(const SoftMaterial& material);

/// Presets, for models in metres: "skin", "fat", "muscle", "liver", "rubber", "foam", "cloth",
/// "jelly". docs/particles.md has their sources. Thread-safe.
[[nodiscard]] SUNDER_API std::span<const SoftMaterial> material_presets();

/// A preset by its name. @return not_found. Thread-safe.
[[nodiscard]] SUNDER_API Result<SoftMaterial> find_material(std::string_view name);

/// How wide a straight wound of a given length opens in its middle under an even tension
/// (SoftBody::set_tension()), metres. For a flat surface that goes on for at least the length of
/// the wound, or two reaches sqrt(S / (rho k)) of the tissue, on all sides. Within 0.1 % of the
/// membrane's; particles add their own error (docs/particles.md). O(1), thread-safe.
///
/// @param wound_length  metres, from tip to tip. [1e-12, 1e12].
/// @param tension       N/m. [0, 1e12].
/// @return as validate_material(); also for a membrane_stiffness below 1e-12, and for the other
///         arguments, which the text names.
[[nodiscard]] SUNDER_API Result<double> gap_under_tension(const SoftMaterial& material,
                                                          double wound_length, double tension);

/// The inverse: the tension, N/m, under which the wound opens by `gap` metres, [0, 1e12]. For
/// example, 0.008 for a wound of 0.06 that gapes by 8 mm.
[[nodiscard]] SUNDER_API Result<double> tension_for_gap(const SoftMaterial& material,
                                                        double wound_length, double gap);

}  // namespace sunder
