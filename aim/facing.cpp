#include "aim/facing.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/internal/bone_sides.h"
#include "core/internal/ordered.h"
#include "operation/internal/view_sides.h"

namespace sunder::aim {
namespace {

/// Pairs of bones that tell the side, at least, and how well they must agree for certainty.
constexpr std::size_t kLeastPairs = 2;
constexpr double kLeastAgreement = 0.7;
/// A direction within 15 degrees of an axis is meant to be the axis.
constexpr double kAxisCosine = 0.966;
/// Feet point forward if their direction leans to the front by no more than 60 degrees.
constexpr double kLeastFootCosine = 0.5;
/// Cosine of the least angle between a bone and the front at which it is seen from there unless
/// told otherwise: 30 degrees.
constexpr double kMostCosine = 0.866;

Vec3d level(const Vec3d& direction) { return {direction.x(), 0.0, direction.z()}; }

/// The two bones of a pair.
struct Pair {
  Index left = 0, right = 0;
};

std::vector<Pair> pairs_of(const Skeleton& skeleton) {
  const std::vector<Index> mirrored = mirrored_bones(skeleton);
  std::vector<Pair> pairs;
  for (Index bone = 0; bone < mirrored.size(); ++bone)
    if (mirrored[bone] != kNone && side_of_name(skeleton.bones[bone].name) < 0)
      pairs.push_back({bone, mirrored[bone]});
  return pairs;
}

/// The nearest axis of the ground if it is near, so that a rig that is crooked by some degrees is
/// seen straight.
Vec3d straightened(const Vec3d& direction) {
  for (const Vec3d& axis : {Vec3d(0, 0, 1), Vec3d(0, 0, -1), Vec3d(1, 0, 0), Vec3d(-1, 0, 0)})
    if (dot(direction, axis) >= kAxisCosine) return axis;
  return direction;
}

/// Whether the lowest pair of bones, the feet or toes, points to the back instead of the front.
bool are_feet_reversed(const Skeleton& skeleton, const ModelPose& pose,
                       const std::vector<Pair>& pairs, const Vec3d& front) {
  const auto at = [&](Index bone) { return pose.model_from_bone[bone].translation(); };
  const auto lowest = std::min_element(
      pairs.begin(), pairs.end(),
      [&](const Pair& a, const Pair& b) { return at(a.left).y() < at(b.left).y(); });
  if (lowest == pairs.end()) return false;
  // A foot for inverse kinematics hangs on the root, which says nothing about its direction.
  const Index leg = skeleton.bones[lowest->left].parent;
  if (std::ranges::none_of(pairs, [&](const Pair& pair) { return pair.left == leg; })) return false;
  const Vec3d way = level(at(lowest->left) - at(leg));
  return norm(way) > 0 && dot(way, front) < -kLeastFootCosine * norm(way);
}

}  // namespace

Result<Facing> facing_of(const Character& character) {
  const Result<ModelPose> pose = rest_pose(character);
  if (!pose) return pose.error();
  const std::vector<Pair> pairs = pairs_of(character.skeleton);
  Vec3d left = Vec3d::Zero();
  double apart = 0;
  for (const Pair& pair : pairs) {
    const Vec3d way = pose->model_from_bone[pair.left].translation() -
                      pose->model_from_bone[pair.right].translation();
    left += way;
    apart += norm(way);
  }
  Facing facing;
  const Vec3d flat = level(left);
  if (!(norm(flat) > 0)) return facing;
  facing.direction = straightened((flat / norm(flat)).cross(Vec3d(0, 1, 0)));
  facing.is_certain = pairs.size() >= kLeastPairs && norm(flat) >= kLeastAgreement * apart &&
                      !are_feet_reversed(character.skeleton, *pose, pairs, facing.direction);
  return facing;
}

Vec3d side_direction(ViewSide side, const Vec3d& front) {
  const Vec3d as_in_file = kViewSides[static_cast<std::size_t>(side)].towards_viewer();
  const Vec3d left = Vec3d(0, 1, 0).cross(front);
  return Vec3d(as_in_file.x() * left + as_in_file.z() * front + Vec3d(0, as_in_file.y(), 0));
}

Vec3d default_direction(const Limb& limb, const Vec3d& front) {
  const bool is_across = std::abs(dot(front, limb.segment.direction())) < kMostCosine;
  return side_direction(is_across ? ViewSide::front : ViewSide::left, front);
}

}  // namespace sunder::aim
