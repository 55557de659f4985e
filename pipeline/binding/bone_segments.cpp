#include "pipeline/binding/bone_segments.h"

#include <algorithm>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"
#include "pipeline/binding/bone_pairs.h"
#include "skinning/internal/character_pose.h"

namespace sunder::binding {
namespace {

/// Bones end before the surface that they move, so that its outermost place does not touch them.
constexpr double kInside = 0.9;
/// Joints nearer than this share of the distance of the farthest two are at one place.
constexpr double kSamePlace = 1e-6;

/// The vertices that each bone moves predominantly, posed.
std::vector<std::vector<Vec3d>> own_vertices(const Joined& joined) {
  const Character& rig = joined.rig;
  std::vector<std::vector<Vec3d>> own(rig.skeleton.bones.size());
  CharacterPose pose;
  or_throw(pose.set(rig, {joined.rig_from_bone, rig.rest_morph_weights}));
  for (const Mesh& mesh : rig.meshes)
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const auto influences = mesh.weights.of(v);
      const auto most = std::ranges::max_element(influences, {}, &Influence::weight);
      own[rig.skins[mesh.skin].bones[most->slot]].push_back(pose.position(mesh, v));
    }
  return own;
}

class Segments {
 public:
  Segments(const Joined& joined, const std::vector<bool>& is_chosen)
      : bones_(joined.rig.skeleton.bones), is_chosen_(is_chosen), own_(own_vertices(joined)) {
    Eigen::AlignedBox3d box;
    for (const Affine3d& matrix : joined.rig_from_bone) {
      joints_.emplace_back(matrix.translation());
      box.extend(Eigen::Vector3d(matrix.translation()));
    }
    same_place_ = kSamePlace * norm(Vec3d(box.diagonal()));
  }

  std::vector<BoneSegment> run() {
    std::vector<std::vector<Index>> below(bones_.size());
    for (Index i = 0; i < bones_.size(); ++i)
      if (const Index above = chosen_above(i); is_chosen_[i] && above != kNone)
        below[above].push_back(i);
    std::vector<BoneSegment> segments;
    for (Index i = 0; i < bones_.size(); ++i) {
      if (!is_chosen_[i]) continue;
      const std::size_t before = segments.size();
      for (const Index child : below[i])
        if (distance(i, child) > same_place_) segments.push_back({i, joints_[i], joints_[child]});
      if (segments.size() == before) segments.push_back({i, joints_[i], end_of_leaf(i)});
    }
    return segments;
  }

 private:
  [[nodiscard]] double distance(Index a, Index b) const {
    return norm(Vec3d(joints_[a] - joints_[b]));
  }

  /// The nearest chosen ancestor.
  [[nodiscard]] Index chosen_above(Index bone) const {
    Index above = bones_[bone].parent;
    while (above != kNone && !is_chosen_[above]) above = bones_[above].parent;
    return above;
  }

  [[nodiscard]] Vec3d end_of_leaf(Index bone) const {
    const Vec3d& joint = joints_[bone];
    if (!own_[bone].empty()) {
      Vec3d mean = Vec3d::Zero();
      for (const Vec3d& position : own_[bone]) mean += position;
      const Vec3d along = normalized(Vec3d(mean / static_cast<double>(own_[bone].size()) - joint));
      double reach = 0;
      for (const Vec3d& position : own_[bone])
        reach = std::max(reach, dot(along, Vec3d(position - joint)));
      return joint + kInside * reach * along;
    }
    for (Index above = bones_[bone].parent; above != kNone; above = bones_[above].parent)
      if (distance(bone, above) > same_place_) return joint + (joint - joints_[above]);
    return joint;
  }

  const std::vector<Bone>& bones_;
  const std::vector<bool>& is_chosen_;
  std::vector<std::vector<Vec3d>> own_;
  std::vector<Vec3d> joints_;
  double same_place_ = 0;
};

}  // namespace

Result<std::vector<bool>> choose_bones(const Character& rig,
                                       const std::vector<std::string>& names) {
  std::vector<bool> is_chosen(rig.skeleton.bones.size(), false);
  for (const std::string& name : names) {
    const Result<Index> bone = find_bone_named(rig.skeleton, name, "the rig");
    if (!bone) return bone.error();
    is_chosen[*bone] = true;
  }
  if (names.empty())
    for (const Mesh& mesh : rig.meshes)
      for (const Influence& influence : mesh.weights.influences)
        is_chosen[rig.skins[mesh.skin].bones[influence.slot]] = true;
  if (std::ranges::find(is_chosen, true) == is_chosen.end())
    is_chosen.assign(is_chosen.size(), true);
  return is_chosen;
}

std::vector<BoneSegment> bone_segments(const Joined& joined, const std::vector<bool>& is_chosen) {
  return Segments(joined, is_chosen).run();
}

}  // namespace sunder::binding
