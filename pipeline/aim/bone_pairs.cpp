#include "pipeline/aim/bone_pairs.h"

#include <algorithm>
#include <cmath>

#include "core/internal/bone_sides.h"
#include "core/internal/ordered.h"

namespace sunder::aim {
namespace {

/// Places mirror each other within this share of the diagonal of all bones' places.
constexpr double kTolerance = 0.02;
/// Share of the bones beside the plane that have a partner, at least.
constexpr double kLeastPaired = 0.7;
/// A plane is not the one of symmetry if the other one pairs as many bones, times this.
constexpr double kLeastLead = 2.0;

Vec3d place(const ModelPose& pose, Index bone) {
  return Vec3d(pose.model_from_bone[bone].translation());
}

/// Sets the left side of pairs whose order is known.
void find_side(BonePairs& found, const ModelPose& pose) {
  Vec3d left = Vec3d::Zero();
  double apart = 0;
  for (const BonePair& pair : found.pairs) {
    const Vec3d way = place(pose, pair.left) - place(pose, pair.right);
    left += way;
    apart += norm(way);
  }
  const Vec3d level(left.x(), 0.0, left.z());
  if (!(norm(level) > 0)) return;
  found.left = level / norm(level);
  found.agreement = norm(level) / apart;
}

std::vector<Index> moving_bones(const Character& character) {
  std::vector<bool> moves(character.skeleton.bones.size());
  for (const Mesh& mesh : character.meshes)
    for (const Influence& influence : mesh.weights.influences)
      moves[character.skins[mesh.skin].bones[influence.slot]] = true;
  std::vector<Index> bones;
  for (Index bone = 0; bone < moves.size(); ++bone)
    if (moves[bone]) bones.push_back(bone);
  return bones;
}

/// The places of bones, and the plane across an axis in which they may mirror each other.
class Mirror {
 public:
  Mirror(const std::vector<Index>& bones, const ModelPose& pose, int axis)
      : bones_(bones), axis_(axis) {
    Vec3d lower = Vec3d::Constant(1e300), upper = -lower;
    std::vector<double> along;
    for (const Index bone : bones) {
      places_.push_back(place(pose, bone));
      lower = lower.cwiseMin(places_.back());
      upper = upper.cwiseMax(places_.back());
      along.push_back(places_.back()[axis]);
    }
    tolerance_ = kTolerance * norm(Vec3d(upper - lower));
    // Bones of the spine lie in the plane; they are the middle ones, also beside one-sided props.
    std::ranges::nth_element(along, along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2));
    offset_ = along[along.size() / 2];
    pair();
  }

  [[nodiscard]] const std::vector<BonePair>& pairs() const { return pairs_; }
  /// Of the bones beside the plane, the share that has a partner.
  [[nodiscard]] double share() const {
    return beside_ > 0 ? 2.0 * static_cast<double>(pairs_.size()) / static_cast<double>(beside_)
                       : 0.0;
  }

 private:
  /// Each bone is the partner of at most one other, the nearest to its mirrored place.
  void pair() {
    std::vector<bool> is_taken(bones_.size());
    for (std::size_t i = 0; i < bones_.size(); ++i) {
      const double distance = places_[i][axis_] - offset_;
      if (std::abs(distance) <= tolerance_) continue;
      ++beside_;
      if (distance < 0) continue;
      Vec3d mirrored = places_[i];
      mirrored[axis_] = offset_ - distance;
      std::size_t nearest = bones_.size();
      double least = tolerance_;
      for (std::size_t j = 0; j < bones_.size(); ++j)
        if (const double away = norm(Vec3d(places_[j] - mirrored)); !is_taken[j] && away < least) {
          least = away;
          nearest = j;
        }
      if (nearest == bones_.size()) continue;
      is_taken[nearest] = true;
      pairs_.push_back({bones_[i], bones_[nearest]});
    }
  }

  const std::vector<Index>& bones_;
  int axis_;
  double tolerance_ = 0, offset_ = 0;
  std::size_t beside_ = 0;
  std::vector<Vec3d> places_;
  std::vector<BonePair> pairs_;
};

/// Orders pairs by the sides that names tell, if any does and they agree about the side in space.
void order_by_side(BonePairs& found, const Skeleton& skeleton) {
  int left_first = 0;
  for (const BonePair& pair : found.pairs) {
    const int one = side_of_name(skeleton.bones[pair.left].name);
    const int other = side_of_name(skeleton.bones[pair.right].name);
    if (one == -other) left_first -= one;
  }
  found.is_side_known = left_first != 0;
  if (left_first < 0)
    for (BonePair& pair : found.pairs) std::swap(pair.left, pair.right);
}

}  // namespace

BonePairs pairs_by_name(const Character& character, const ModelPose& pose) {
  const Skeleton& skeleton = character.skeleton;
  const std::vector<Index> mirrored = mirrored_bones(skeleton);
  BonePairs found;
  for (Index bone = 0; bone < mirrored.size(); ++bone)
    if (mirrored[bone] != kNone && side_of_name(skeleton.bones[bone].name) < 0)
      found.pairs.push_back({bone, mirrored[bone]});
  find_side(found, pose);
  found.is_side_known = !found.pairs.empty();
  return found;
}

BonePairs pairs_by_place(const Character& character, const ModelPose& pose) {
  const std::vector<Index> bones = moving_bones(character);
  if (bones.empty()) return {};
  const Mirror x(bones, pose, 0), z(bones, pose, 2);
  const bool is_x = x.pairs().size() >= z.pairs().size();
  const Mirror& better = is_x ? x : z;
  const Mirror& other = is_x ? z : x;
  if (better.share() < kLeastPaired) return {};
  if (static_cast<double>(better.pairs().size()) <
      kLeastLead * static_cast<double>(other.pairs().size()))
    return {};
  BonePairs found;
  found.pairs = better.pairs();
  order_by_side(found, character.skeleton);
  find_side(found, pose);
  return found;
}

}  // namespace sunder::aim
