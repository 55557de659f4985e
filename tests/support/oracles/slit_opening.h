#pragma once

namespace sunder::test {

/// How wide a slit in an infinite membrane on an elastic foundation opens in its middle, relative
/// to the ellipse that it is without a foundation. By the boundary integral equation of the slit,
/// with a series of sines, within about 1e-6.
/// @param half_length  in reaches sqrt(S / (rho k)); from 0.001 to 20.
double slit_opening(double half_length);

}  // namespace sunder::test
