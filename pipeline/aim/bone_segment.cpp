#include "pipeline/aim/bone_segment.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <vector>

#include "core/internal/ordered.h"

namespace sunder::aim {
namespace {

/// Of several children, a bone leads to one within 60 degrees of its own direction, or to none.
constexpr double kLeastCosineOfSeveral = 0.5;
/// A single child behind the joint is not what the bone leads to.
constexpr double kLeastCosineOfOne = 0.0;
/// The surface that a bone moves lies around its joint if its middle is nearer than this share of
/// its extent.
constexpr double kAroundJointExtents = 0.1;

/// The joints of a pose that does not depend on the operation's: a bone leads to the same child in
/// every pose.
class Joints {
 public:
  Joints(const BoneTree& tree, const ModelPose& pose, double size)
      : tree_(tree), pose_(pose), least_(kSameJointSizes * size) {}

  [[nodiscard]] Vec3d at(Index bone) const { return pose_.model_from_bone[bone].translation(); }

  /// The direction in which the skeleton's chain arrives at a bone; zero at its first joint. An
  /// adopted bone lies beside its parent as often as in line with it.
  [[nodiscard]] Vec3d arrival(Index bone) const {
    for (Index i = bone; !tree_.is_adopted(i) && tree_.parent(i) != kNone; i = tree_.parent(i)) {
      const Vec3d way = at(bone) - at(tree_.parent(i));
      if (norm(way) > least_) return way / norm(way);
    }
    return Vec3d::Zero();
  }

  /// The children of a bone, with those of children that lie at its own joint.
  [[nodiscard]] std::vector<Index> next_joints(Index bone) const {
    std::vector<Index> next, here = {bone};
    while (!here.empty()) {
      const Index top = here.back();
      here.pop_back();
      for (const Index child : tree_.children(top))
        (norm(at(child) - at(bone)) > least_ ? next : here).push_back(child);
    }
    return next;
  }

 private:
  const BoneTree& tree_;
  const ModelPose& pose_;
  double least_;
};

/// The part of the surface that a bone moves predominantly.
struct Moved {
  Vec3d middle = Vec3d::Zero();
  double extent = 0;  ///< Largest distance from the joint.
  std::vector<Index> points;
};

Moved points_of(const PosedSurface& surface, const std::vector<Index>& own) {
  Moved moved;
  const Vec3d joint = surface.joint(own.front());
  std::vector<double> weights(surface.surface().point_count(), 0.0);
  double largest = 0;
  for (Index point = 0; point < weights.size(); ++point) {
    for_each_influence(surface, point, [&](Index of, double weight) {
      if (std::find(own.begin(), own.end(), of) != own.end()) weights[point] += weight;
    });
    largest = std::max(largest, weights[point]);
  }
  for (Index point = 0; point < weights.size(); ++point) {
    if (!(weights[point] >= 0.5 * largest) || !(weights[point] > 0)) continue;
    moved.points.push_back(point);
    moved.middle += surface.position(point);
    moved.extent = std::max(moved.extent, norm(surface.position(point) - joint));
  }
  if (!moved.points.empty()) moved.middle /= static_cast<double>(moved.points.size());
  return moved;
}

/// The weights of a bone and all below it.
double weight_below(const BoneTree& tree, Index bone) {
  double sum = tree.weight(bone);
  for (const Index child : tree.children(bone)) sum += weight_below(tree, child);
  return sum;
}

/// The child that continues the direction of the chain best; kNone if none continues it.
/// @param own  bones that are one with it: it leads to none of them.
Index next_bone(const Joints& joints, const BoneTree& tree, Index bone,
                const std::vector<Index>& own, const Vec3d& own_direction) {
  std::vector<Index> children = joints.next_joints(bone);
  std::erase_if(children, [&](Index child) { return std::ranges::count(own, child) > 0; });
  if (children.empty()) return kNone;
  Vec3d ahead = joints.arrival(bone);
  if (ahead == Vec3d::Zero()) ahead = own_direction;
  if (ahead == Vec3d::Zero())  // a root without a direction: towards most of the model
    return *std::max_element(children.begin(), children.end(), [&](Index a, Index b) {
      return weight_below(tree, a) < weight_below(tree, b);
    });
  Index best = kNone;
  double best_cosine = children.size() == 1 ? kLeastCosineOfOne : kLeastCosineOfSeveral;
  for (const Index child : children) {
    const Vec3d way = joints.at(child) - joints.at(bone);
    const double cosine = dot(way, ahead) / norm(way);
    if (!(cosine > best_cosine)) continue;
    best = child;
    best_cosine = cosine;
  }
  return best;
}

/// The end of the surface that a bone moves, along the direction of its middle.
Vec3d end_of_moved(const PosedSurface& surface, const Moved& moved, const Vec3d& start,
                   const Vec3d& arrival) {
  Vec3d direction = moved.middle - start;
  if (norm(direction) < kAroundJointExtents * moved.extent && !(arrival == Vec3d::Zero()))
    direction = arrival;
  if (!(norm(direction) > 0)) return start;
  direction /= norm(direction);
  double length = 0;
  for (const Index point : moved.points)
    length = std::max(length, dot(surface.position(point) - start, direction));
  return start + length * direction;
}

}  // namespace

Vec3d BoneSegment::direction() const { return (end - start) / norm(end - start); }
double BoneSegment::length() const { return norm(end - start); }

Result<BoneSegment> bone_segment(const PosedSurface& surface, const BoneTree& tree, Index bone) {
  const Character& character = surface.character();
  const char* const name = character.skeleton.bones[bone].name.c_str();
  const std::vector<Index> same = tree.same_bones(character.skeleton, bone);
  const Moved moved = points_of(surface, same);
  if (moved.points.empty())
    return Status::failure(StatusCode::not_found, bone,
                           "the bone '%.60s' moves no vertex of the model", name);
  const Result<ModelPose> bind = bind_pose(character);
  if (!bind) return bind.error();
  const Vec3d start = surface.joint(bone);
  const Joints at_bind(tree, *bind, surface.size()), in_pose(tree, surface.pose(), surface.size());
  // The root's own direction is that of what it moves, unless that lies around its joint.
  Vec3d own = moved.middle - start;
  own = norm(own) < kAroundJointExtents * moved.extent ? Vec3d(Vec3d::Zero()) : normalized(own);
  BoneSegment segment;
  segment.start = start;
  segment.next = next_bone(at_bind, tree, bone, same, own);
  segment.end = segment.next != kNone ? surface.joint(segment.next)
                                      : end_of_moved(surface, moved, start, in_pose.arrival(bone));
  if (!(segment.length() > kSameJointSizes * surface.size()))
    return Status::failure(StatusCode::invalid_argument, bone,
                           "the bone '%.60s' has no length in this pose", name);
  return segment;
}

}  // namespace sunder::aim
