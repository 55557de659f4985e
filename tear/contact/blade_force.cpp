#include <sunder/tear/blade_force.h>

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"

namespace sunder {
namespace {

Status check_field(double value, const char* name) {
  if (!std::isfinite(value))
    return Status::failure(StatusCode::non_finite_value, kNone, "%s is not finite", name);
  if (value < 0)
    return Status::failure(StatusCode::invalid_argument, kNone, "%s is %g; it must be >= 0", name,
                           value);
  return {};
}

Status check(const CuttingResistance& tissue, const BladeStep& step) {
  const struct {
    double value;
    const char* name;
  } fields[] = {{tissue.toughness, "the toughness"},
                {tissue.thickness, "the thickness"},
                {tissue.friction, "the friction"},
                {tissue.greatest, "the greatest force"},
                {step.length_torn, "the length torn"}};
  for (const auto& field : fields)
    if (Status status = check_field(field.value, field.name); !status) return status;
  if (tissue.greatest == 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the greatest force is 0; it must be > 0");
  if (!std::isfinite(step.depth))
    return Status::failure(StatusCode::non_finite_value, kNone, "the depth is not finite");
  if (!step.motion.allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone, "the motion is not finite");
  return {};
}

}  // namespace

Result<BladeForce> blade_force(const CuttingResistance& tissue, const BladeStep& step) {
  if (Status status = check(tissue, step); !status) return status;
  const double moved = norm(step.motion);
  if (!(moved > tear::kShortestMetres)) return BladeForce{};
  const double depth = std::max(0.0, step.depth);
  const double work = tissue.toughness * step.length_torn * std::min(depth, tissue.thickness);
  const double newtons = work / moved + tissue.friction * depth;
  return BladeForce{std::min(newtons, tissue.greatest), -step.motion / moved};
}

}  // namespace sunder
