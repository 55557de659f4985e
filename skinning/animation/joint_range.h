#pragma once

#include <sunder/animation/pull.h>

namespace sunder::animation {

/// The rotations that a bone may take relative to its parent.
class JointRange {
 public:
  /// Any rotation.
  JointRange() = default;
  /// @param limit  checked. @param rest  unit quaternion.
  JointRange(const BoneLimit& limit, const Quatd& rest);

  [[nodiscard]] bool is_hinge() const { return kind_ == Kind::hinge; }
  [[nodiscard]] bool is_free() const { return kind_ == Kind::free; }
  /// The axis of a hinge in the parent's frame.
  [[nodiscard]] Vec3d axis_in_parent() const;

  /// The rotation itself if it is allowed, else one at the nearest limits.
  [[nodiscard]] Quatd clamped(const Quatd& rotation) const;
  /// A rotation turned further, within the limits. @param turn  rotation vector in the parent's
  /// frame; only its part along the axis counts for a hinge.
  [[nodiscard]] Quatd turned(const Quatd& rotation, const Vec3d& turn) const;

 private:
  enum class Kind : std::uint8_t { free, hinge, cone };

  [[nodiscard]] double hinge_angle(const Quatd& rotation) const;
  [[nodiscard]] Quatd hinge_at(double angle) const;
  [[nodiscard]] Quatd clamped_cone(const Quatd& relative) const;

  Kind kind_ = Kind::free;
  Quatd rest_ = Quatd::Identity();
  Vec3d axis_ = Vec3d(1.0, 0.0, 0.0);
  double lower_ = 0.0, upper_ = 0.0, cone_ = 0.0;
};

}  // namespace sunder::animation
