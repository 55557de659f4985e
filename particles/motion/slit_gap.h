#pragma once

namespace sunder::particles {

/// How wide a slit in a large, flat membrane on an elastic foundation opens in its middle, relative
/// to a slit much longer than the reach of the membrane: from 0 to 1, within 0.1 %. The arguments
/// and the derivation are in docs/method/particles.md.
/// @param half_length  of the slit, in reaches sqrt(S / (rho k)); >= 0, may be infinite.
[[nodiscard]] double slit_gap(double half_length);

}  // namespace sunder::particles
