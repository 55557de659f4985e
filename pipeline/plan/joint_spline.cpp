#include "pipeline/plan/joint_spline.h"

#include <algorithm>
#include <cmath>

namespace sunder::plan {

SplineWeights spline_weights(double time, double duration, std::size_t intervals) {
  const double at = std::clamp(time / duration, 0.0, 1.0) * static_cast<double>(intervals);
  const std::size_t first = std::min(static_cast<std::size_t>(at), intervals - 1);
  const double u = at - static_cast<double>(first), v = 1 - u;
  return {first,
          {v * v * v / 6, (3 * u * u * u - 6 * u * u + 4) / 6, (3 * v * v * v - 6 * v * v + 4) / 6,
           u * u * u / 6}};
}

Values JointSpline::at(double time) const {
  const SplineWeights of = spline_weights(time, duration, intervals());
  Values values = of.weights[0] * control[of.first];
  for (std::size_t i = 1; i < 4; ++i) values += of.weights[i] * control[of.first + i];
  return values;
}

}  // namespace sunder::plan
