#include "io/usd_write/joints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "core/internal/moved_bones.h"
#include "io/gltf/decompose.h"
#include "io/gltf_write/mesh_writer.h"
#include "io/usd_write/half.h"
#include "io/usd_write/identifiers.h"
#include "skinning/internal/bone_tree.h"

namespace sunder::usd {
namespace {

/// A half that is off by less than a float is the same scale.
bool is_half(float value) {
  return std::abs(nearest_half(value) - value) <= 2e-7f * std::abs(value);
}

/// The factors of a scale that an animation cannot hold; one where it can, or where nothing is
/// left to divide by.
Vec3f beyond_halves(const Vec3f& scale) {
  Vec3f factors = Vec3f::Ones();
  for (int i = 0; i < 3; ++i)
    if (!is_half(scale[i])) factors[i] = scale[i];
  return factors;
}

bool has_inverse(const Affine3d& matrix) {
  const double size = matrix.linear().cwiseAbs().maxCoeff();
  return std::abs(matrix.linear().determinant()) > 1e-12 * size * size * size;
}

/// The corners of a box around the points that a skin moves.
using Corners = std::array<Vec3d, 8>;

/// One box per skin; empty for skins of no written mesh.
std::vector<Eigen::AlignedBox3d> boxes_of_skins(const Character& character) {
  std::vector<Eigen::AlignedBox3d> boxes(character.skins.size());
  for (const Mesh& mesh : character.meshes)
    if (gltf::MeshWriter::has_triangles(mesh))
      for (const Vec3f& position : mesh.positions)
        boxes[mesh.skin].extend(Eigen::Vector3d(position.cast<double>()));
  return boxes;
}

Corners corners_of(const Eigen::AlignedBox3d& box) {
  Corners corners;
  for (unsigned i = 0; i < corners.size(); ++i)
    for (unsigned axis = 0; axis < 3; ++axis)
      corners[i][axis] = (i >> axis & 1) != 0 ? box.max()[axis] : box.min()[axis];
  return corners;
}

/// Whether two matrices move the corners alike, to within what floats tell.
bool move_alike(const Affine3d& a, const Affine3d& b, const Corners& corners) {
  double difference = 0, distance = 0, size = 0;
  for (const Vec3d& corner : corners) {
    const Vec3d place = b * corner;
    difference = std::max(difference, (a * corner - place).norm());
    distance = std::max(distance, place.norm());
    size = std::max(size, (place - b * corners[0]).norm());
  }
  return difference <= 1e-6 * size + 1e-7 * distance;
}

}  // namespace

class Joints::Builder {
 public:
  Builder(const Character& character, Joints& result) : character_(character), result_(result) {}

  void build() {
    add_bones();
    const std::vector<Eigen::AlignedBox3d> boxes = boxes_of_skins(character_);
    result_.skins_.resize(character_.skins.size());
    for (std::size_t skin = 0; skin < boxes.size(); ++skin)
      if (!boxes[skin].isEmpty()) bind(skin, corners_of(boxes[skin]));
    bind_others();
  }

 private:
  std::uint32_t add(std::uint32_t parent, const std::string& leaf, const Affine3d& rest) {
    Joint joint;
    const std::string unique = leaves_.add(leaf, "joint");
    joint.path = parent == kNone ? unique : result_.joints_[parent].path + "/" + unique;
    joint.name = unique;
    joint.parent = parent;
    joint.parent_from_joint = rest;
    result_.joints_.push_back(std::move(joint));
    is_bound_.push_back(false);
    return static_cast<std::uint32_t>(result_.joints_.size() - 1);
  }

  void add_bones() {
    const std::vector<bool> is_moved = bones_moved_by_clips(character_);
    const std::vector<Bone>& bones = character_.skeleton.bones;
    const bool has_roots = std::ranges::count(bones, kNone, &Bone::parent) > 1;
    const std::uint32_t root = has_roots ? add(kNone, "Root", Affine3d::Identity()) : kNone;
    for (std::size_t b = 0; b < is_moved.size(); ++b) {
      const Bone& bone = bones[b];
      const Vec3f below = is_moved[b] ? beyond_halves(bone.rest.scale) : Vec3f(Vec3f::Ones());
      BoneTransform rest = bone.rest;
      rest.scale = rest.scale.cwiseQuotient(below);
      const std::uint32_t joint = add(bone.parent == kNone ? root : joints_of_[bone.parent][0],
                                      bone.name, skinning::to_matrix(rest));
      result_.joints_[joint].name = bone.name;
      result_.moved_.push_back(joint);
      result_.scale_below_.push_back(below);
      std::uint32_t last = joint;
      if (below != Vec3f::Ones())
        last = add(joint, bone.name + "_scale", Affine3d(below.cast<double>().asDiagonal()));
      joints_of_.push_back({last});
    }
  }

  void bind(std::size_t skin, const Corners& corners) {
    const Skin& of = character_.skins[skin];
    SkinJoints& result = result_.skins_[skin];
    result.joints_from_mesh = common_factor(of, corners);
    for (std::size_t slot = 0; slot < of.bones.size(); ++slot)
      result.joint_of_slot.push_back(joint_for(of.bones[slot],
                                               of.bone_from_bind[slot].cast<double>(),
                                               result.joints_from_mesh, corners));
  }

  /// By the first slot whose joint another skin has bound.
  [[nodiscard]] Affine3d common_factor(const Skin& skin, const Corners& corners) const {
    for (std::size_t slot = 0; slot < skin.bones.size(); ++slot) {
      const std::uint32_t joint = joints_of_[skin.bones[slot]][0];
      const Affine3d bone_from_mesh = skin.bone_from_bind[slot].cast<double>();
      if (!is_bound_[joint] || !has_inverse(bone_from_mesh)) continue;
      const Affine3d& model_from_bind = result_.joints_[joint].model_from_bind;
      if (move_alike(model_from_bind.inverse(), bone_from_mesh, corners)) break;
      return model_from_bind * bone_from_mesh;
    }
    return Affine3d::Identity();
  }

  std::uint32_t joint_for(std::uint32_t bone, const Affine3d& bone_from_mesh,
                          const Affine3d& joints_from_mesh, const Corners& corners) {
    const std::string copy = character_.skeleton.bones[bone].name + "_bind";
    if (!has_inverse(bone_from_mesh)) {
      const gltf::Decomposition rest = gltf::decompose(bone_from_mesh);
      std::uint32_t joint = add(joints_of_[bone][0], copy, skinning::to_matrix(rest.first));
      if (rest.second) joint = add(joint, copy, skinning::to_matrix(*rest.second));
      set_bind(joint, joints_from_mesh);
      return joint;
    }
    for (const std::uint32_t joint : joints_of_[bone]) {
      const Affine3d& bound = result_.joints_[joint].model_from_bind;
      if (is_bound_[joint] &&
          move_alike(Affine3d(bound.inverse() * joints_from_mesh), bone_from_mesh, corners))
        return joint;
    }
    const bool is_free = !is_bound_[joints_of_[bone][0]];
    const std::uint32_t joint =
        is_free ? joints_of_[bone][0] : add(joints_of_[bone][0], copy, Affine3d::Identity());
    if (!is_free) joints_of_[bone].push_back(joint);
    set_bind(joint, joints_from_mesh * bone_from_mesh.inverse());
    return joint;
  }

  void set_bind(std::uint32_t joint, const Affine3d& model_from_bind) {
    result_.joints_[joint].model_from_bind = model_from_bind;
    is_bound_[joint] = true;
  }

  /// Joints without vertices stand at bind as at rest, or without a turn if that is flat.
  void bind_others() {
    std::vector<Affine3d> model_from_joint;
    for (std::size_t j = 0; j < result_.joints_.size(); ++j) {
      Joint& joint = result_.joints_[j];
      model_from_joint.push_back(joint.parent == kNone
                                     ? joint.parent_from_joint
                                     : model_from_joint[joint.parent] * joint.parent_from_joint);
      if (is_bound_[j]) continue;
      joint.model_from_bind = model_from_joint[j];
      if (!has_inverse(joint.model_from_bind)) joint.model_from_bind.linear().setIdentity();
    }
  }

  const Character& character_;
  Joints& result_;
  Identifiers leaves_;
  std::vector<bool> is_bound_;                         ///< One per joint.
  std::vector<std::vector<std::uint32_t>> joints_of_;  ///< Per bone: that of its children, copies.
};

Joints::Joints(const Character& character) { Builder(character, *this).build(); }

}  // namespace sunder::usd
