#include "pipeline/aim/facing.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/internal/ordered.h"
#include "core/operation/internal/view_sides.h"
#include "pipeline/aim/bone_pairs.h"

namespace sunder::aim {
namespace {

/// Pairs of bones that tell the side, at least, and how well they must agree for certainty.
constexpr std::size_t kLeastPairs = 2;
constexpr double kLeastAgreement = 0.7;
/// A direction within 15 degrees of an axis is meant to be the axis.
constexpr double kAxisCosine = 0.966;
/// Feet that reach at least this share of their length to the front or the back tell which is
/// which.
constexpr double kLeastReach = 0.1;
/// Pairs of bones that are above the lowest by at most this share of what all are apart are feet.
constexpr double kFootHeight = 0.15;
/// Cosine of the least angle between a bone and the front at which it is seen from there unless
/// told otherwise: 30 degrees.
constexpr double kMostCosine = 0.866;

/// The nearest axis of the ground if it is near, so that a rig that is crooked by some degrees is
/// seen straight.
Vec3d straightened(const Vec3d& direction) {
  for (const Vec3d& axis : {Vec3d(0, 0, 1), Vec3d(0, 0, -1), Vec3d(1, 0, 0), Vec3d(-1, 0, 0)})
    if (dot(direction, axis) >= kAxisCosine) return axis;
  return direction;
}

/// Per bone: whether it is `top` or hangs below it. Parents come before children.
std::vector<bool> branch_of(const Skeleton& skeleton, Index top) {
  std::vector<bool> is_in(skeleton.bones.size());
  for (Index bone = 0; bone < is_in.size(); ++bone)
    is_in[bone] =
        bone == top || (skeleton.bones[bone].parent != kNone && is_in[skeleton.bones[bone].parent]);
  return is_in;
}

/// Sum and number of the ways from a joint to the vertices that its branch moves most, and the
/// longest of them.
struct Ways {
  Vec3d sum = Vec3d::Zero();
  double count = 0, longest = 0;

  void add(const Vec3d& way) {
    sum += way;
    ++count;
    longest = std::max(longest, norm(way));
  }
};

void add_ways(Ways& ways, const Character& character, const ModelPose& pose, Index joint) {
  const std::vector<bool> is_in = branch_of(character.skeleton, joint);
  const Vec3d from(pose.model_from_bone[joint].translation());
  for (const Mesh& mesh : character.meshes) {
    const Skin& skin = character.skins[mesh.skin];
    for (Index vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
      const Influence& most = *std::ranges::max_element(
          mesh.weights.of(vertex), {}, [](const Influence& influence) { return influence.weight; });
      const Index bone = skin.bones[most.slot];
      if (!is_in[bone]) continue;
      const Affine3d model_from_bind =
          pose.model_from_bone[bone] * skin.bone_from_bind[most.slot].cast<double>();
      ways.add(Vec3d(model_from_bind * mesh.positions[vertex].cast<double>()) - from);
    }
  }
}

/// How far the feet reach to the front of their joints: in [-1, 1], of their length; 0 if there are
/// none. Feet are what the lowest pairs of bones move, those of hands not counted; the bones
/// themselves where no pair moves anything.
double reach_of_feet(const Character& character, const ModelPose& pose, std::vector<BonePair> pairs,
                     const Vec3d& front) {
  if (pairs.empty()) return 0;
  const auto at = [&](Index bone) { return Vec3d(pose.model_from_bone[bone].translation()); };
  const auto height = [&](const BonePair& pair) { return at(pair.left).y(); };
  std::ranges::stable_sort(pairs, {}, height);
  const double sole = height(pairs.front());
  const double ankle = sole + kFootHeight * (height(pairs.back()) - sole);
  double reach = 0, feet = 0;
  for (const BonePair& pair : pairs) {
    // Pairs far below all others may be targets for inverse kinematics, which move nothing.
    if (feet > 0 && height(pair) > ankle) break;
    Ways ways;
    add_ways(ways, character, pose, pair.left);
    add_ways(ways, character, pose, pair.right);
    if (!(ways.longest > 0)) continue;
    reach += dot(Vec3d(ways.sum / ways.count), front) / ways.longest;
    ++feet;
  }
  if (feet > 0) return reach / feet;
  const Index foot = pairs.front().left, leg = character.skeleton.bones[foot].parent;
  if (leg == kNone) return 0;
  const Vec3d way = at(foot) - at(leg);
  return norm(way) > 0 ? dot(way, front) / norm(way) : 0;
}

}  // namespace

Result<Facing> facing_of(const Character& character) {
  const Result<ModelPose> pose = rest_pose(character);
  if (!pose) return pose.error();
  BonePairs found = pairs_by_name(character, *pose);
  if (found.pairs.size() < kLeastPairs || found.agreement < kLeastAgreement)
    if (BonePairs placed = pairs_by_place(character, *pose); placed.pairs.size() >= kLeastPairs)
      found = std::move(placed);
  Facing facing;
  if (!(norm(found.left) > 0)) return facing;
  Vec3d front = found.left.cross(Vec3d(0, 1, 0));
  const double reach = reach_of_feet(character, *pose, found.pairs, front);
  const bool is_ahead = reach >= kLeastReach, is_behind = reach <= -kLeastReach;
  if (!found.is_side_known && is_behind) front = -front;
  const bool has_front = found.is_side_known ? !is_behind : is_ahead || is_behind;
  if (!found.is_side_known && !has_front) return facing;
  facing.direction = straightened(front);
  facing.is_certain =
      found.pairs.size() >= kLeastPairs && found.agreement >= kLeastAgreement && has_front;
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
