#include "pipeline/plan/blade_errors.h"

#include <algorithm>
#include <cmath>

namespace sunder::plan {
namespace {

/// By how much the place counts less where the tip is highest.
constexpr double kLifted = 20;

}  // namespace

ErrorScales scales_at(const ErrorScales& scales, const TargetSample& sample) {
  // Near the surface the place counts fully: there the blade begins to cut.
  const double height = sample.depth < 0 ? sample.lift * sample.lift : 0;
  return {scales.place * (1 + kLifted * height), scales.depth, scales.angle};
}

BladeErrors blade_errors(const BladePlace& blade, const TargetSample& sample,
                         const ErrorScales& scales, ErrorRates* rates) {
  const double length = (blade.base - blade.tip).norm();
  const Vec3d handle = (blade.base - blade.tip) / length;
  const Vec3d from_tip = sample.place - blade.tip;
  const double along = from_tip.dot(handle);
  BladeErrors errors;
  errors.segment<3>(0) = (from_tip - along * handle) / scales.place;
  errors[3] = (from_tip.dot(sample.normal) - sample.depth) / scales.depth;
  errors.segment<3>(4) = (handle - sample.handle) / scales.angle;
  if (rates == nullptr) return errors;
  rates->resize(7, blade.tip_rates.cols());
  for (Eigen::Index i = 0; i < blade.tip_rates.cols(); ++i) {
    const Vec3d tip = blade.tip_rates.col(i);
    const Vec3d turn = (blade.base_rates.col(i) - tip) / length;  // rigid: the length is constant
    const double rate = turn.dot(from_tip) - handle.dot(tip);
    rates->col(i).segment<3>(0) = (-tip - along * turn - rate * handle) / scales.place;
    (*rates)(3, i) = -tip.dot(sample.normal) / scales.depth;
    rates->col(i).segment<3>(4) = turn / scales.angle;
  }
  return errors;
}

PlainErrors plain_errors(const BladePlace& blade, const TargetSample& sample) {
  const BladeErrors errors = blade_errors(blade, sample, {1, 1, 1}, nullptr);
  const Vec3d handle = (blade.base - blade.tip).normalized();
  PlainErrors plain;
  plain.place = errors.segment<3>(0).norm();
  plain.depth = std::abs(errors[3]);
  plain.angle = std::acos(std::clamp(handle.dot(sample.handle), -1.0, 1.0));
  plain.tip_depth = errors[3] + sample.depth;
  plain.is_base_outside = (blade.base - sample.place).dot(sample.normal) > 0;
  return plain;
}

}  // namespace sunder::plan
