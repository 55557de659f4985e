#pragma once

#include "pipeline/binding/attach.h"

namespace sunder::binding {

/// Keeps the `maximum` largest weights of a row (0: all), without those below a thousandth of the
/// largest, and normalises them. The largest weight that goes is subtracted from those that stay,
/// so that weights fade out where the surface passes from one choice of bones to another instead of
/// jumping.
/// @return the sum of the weights beyond the maximum before, of a row that sums to one.
double limit_weights(std::size_t maximum, WeightRow& row);

}  // namespace sunder::binding
