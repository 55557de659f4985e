#include <sunder/robot/robot.h>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"

namespace sunder {
namespace {

BoneTransform transform_of(const Mat3d& rotation, const Vec3d& translation) {
  BoneTransform transform;
  transform.translation = translation.cast<float>();
  const Quatd turn(rotation);
  const Vec4d unit = normalized(Vec4d(turn.coeffs()));
  transform.rotation.coeffs() = unit.cast<float>();
  return transform;
}

}  // namespace

Status pose_of_links(const Robot& robot, std::span<const Affine3d> model_from_link, Pose& pose) {
  const std::size_t count = robot.links.size();
  if (model_from_link.size() != count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the robot has %zu links; given are %zu frames", count,
                           model_from_link.size());
  for (std::size_t link = 0; link < count; ++link)
    if (robot.links[link].parent != kNone && robot.links[link].parent >= link)
      return Status::failure(StatusCode::not_a_tree, static_cast<std::uint32_t>(link),
                             "link %zu: its parent must have a lower index", link);
  const Status resized = or_out_of_memory([&]() -> Status {
    pose.parent_from_bone.resize(count);
    return {};
  });
  if (!resized) return resized;
  for (std::size_t link = 0; link < count; ++link) {
    const Affine3d& frame = model_from_link[link];
    if (robot.links[link].parent == kNone) {
      pose.parent_from_bone[link] = transform_of(frame.linear(), frame.translation());
      continue;
    }
    const Affine3d& parent = model_from_link[robot.links[link].parent];
    const Mat3d back = parent.linear().transpose();
    pose.parent_from_bone[link] =
        transform_of(multiply(back, Mat3d(frame.linear())),
                     multiply(back, Vec3d(frame.translation() - parent.translation())));
  }
  return {};
}

}  // namespace sunder
