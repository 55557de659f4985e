#include "skinning/animation/internal/limit_of_bones.h"

#include <utility>

namespace sunder::animation {
namespace {

Status check_limit(const BoneLimit& limit, std::uint32_t index, std::size_t bones) {
  if (limit.bone >= bones)
    return Status::failure(StatusCode::index_out_of_range, limit.bone,
                           "bone %u does not exist; the skeleton has %zu", limit.bone, bones);
  if (!limit.axis.allFinite() || limit.axis.isZero(0))
    return Status::failure(StatusCode::invalid_argument, index,
                           "limit %u, of bone %u: its axis is zero or not finite", index,
                           limit.bone);
  if (!(limit.upper - limit.lower >= 0.0))
    return Status::failure(StatusCode::invalid_argument, index,
                           "limit %u, of bone %u: its range is %g to %g", index, limit.bone,
                           limit.lower, limit.upper);
  if (limit.kind == BoneLimit::Kind::cone && !(limit.cone >= 0.0))
    return Status::failure(StatusCode::invalid_argument, index,
                           "limit %u, of bone %u: its cone is %g, but must be >= 0", index,
                           limit.bone, limit.cone);
  return {};
}

}  // namespace

Result<std::vector<const BoneLimit*>> limit_of_bones(std::span<const BoneLimit> limits,
                                                     std::size_t bone_count) {
  for (std::uint32_t i = 0; i < limits.size(); ++i)
    if (const Status status = check_limit(limits[i], i, bone_count); !status) return status;
  std::vector<const BoneLimit*> limit_of(bone_count, nullptr);
  for (const BoneLimit& limit : limits)
    if (std::exchange(limit_of[limit.bone], &limit) != nullptr)
      return Status::failure(StatusCode::invalid_argument, limit.bone, "bone %u has a limit twice",
                             limit.bone);
  return limit_of;
}

}  // namespace sunder::animation
