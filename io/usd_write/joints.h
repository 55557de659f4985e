#pragma once

#include <sunder/core/character.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sunder::usd {

/// A joint of the skeleton that is written.
struct Joint {
  std::string path;  ///< Names from the root on, separated by "/".
  std::string name;  ///< Of the bone, as it is called in the character; others: of the path.
  std::uint32_t parent = kNone;
  Affine3d parent_from_joint = Affine3d::Identity();  ///< At rest.
  Affine3d model_from_bind = Affine3d::Identity();    ///< The "bind transform".
};

/// How the vertices of a skin follow the joints.
struct SkinJoints {
  std::vector<std::uint32_t> joint_of_slot;
  /// The "geomBindTransform": bone_from_bind of a slot is that of its joint, inverted, times this.
  Affine3d joints_from_mesh = Affine3d::Identity();
};

/// The bones of a character as joints: parents before children, one per bone and further ones
/// where USD cannot say with one what a bone does:
///
/// - `Root` stands above several roots, because readers want one.
/// - `…_scale` carries a scale at rest that a half cannot be, where a clip moves the bone: scales
///   of animations are halves, rest transforms are doubles. It has the bone's children.
/// - `…_bind` is a copy that a second skin binds in another way than a common factor can express,
///   or by a matrix without inverse.
class Joints {
 public:
  explicit Joints(const Character& character);

  [[nodiscard]] const std::vector<Joint>& all() const { return joints_; }
  /// The joint that a clip moves.
  [[nodiscard]] std::uint32_t moved(std::uint32_t bone) const { return moved_[bone]; }
  /// The part of the bone's scale that the joint below it has; ones without such a joint.
  [[nodiscard]] const Vec3f& scale_below(std::uint32_t bone) const { return scale_below_[bone]; }
  /// One per skin; empty for skins that no written mesh has.
  [[nodiscard]] const std::vector<SkinJoints>& skins() const { return skins_; }

 private:
  class Builder;
  std::vector<Joint> joints_;
  std::vector<std::uint32_t> moved_;
  std::vector<Vec3f> scale_below_;
  std::vector<SkinJoints> skins_;
};

}  // namespace sunder::usd
