#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>
#include <sunder/core/status.h>

#include <variant>

namespace sunder {

/// A rigid shape that pushes a SoftBody away. A plain value.
struct Collider {
  /// A ball about the origin of the collider's frame.
  struct Sphere {
    double radius = 1.0;  ///< Metres, > 0.
  };
  /// All places within `radius` of the segment from -half_length to half_length on the frame's y
  /// axis.
  struct Capsule {
    double radius = 1.0;       ///< Metres, > 0.
    double half_length = 1.0;  ///< Metres, >= 0.
  };
  /// A box around the origin of the frame, along its axes.
  struct Box {
    Vec3d half_size = Vec3d::Ones();  ///< Metres, each > 0.
  };
  /// The half-space below the frame's plane y = 0.
  struct HalfSpace {};

  std::variant<Sphere, Capsule, Box, HalfSpace> shape;
  Vec3d place = Vec3d::Zero();     ///< Origin of the frame, model space, metres.
  Quatd turn = Quatd::Identity();  ///< Orientation of the frame, unit length.
  double friction = 0.0;           ///< Greatest ratio of tangential to normal force; >= 0.
};

struct SurfaceDistance {
  double distance = 0.0;  ///< Metres to the collider's surface; below 0 inside.
  /// Outward unit normal at the nearest place; if there are several, at any of them.
  Vec3d normal = Vec3d::UnitY();
};

/// The distance of a place in model space from a collider, exact outside and inside. The collider
/// is unchecked. Thread-safe.
[[nodiscard]] SUNDER_API SurfaceDistance distance_to(const Collider& collider, const Vec3d& place);

/// Whether a collider is one: places and sizes are at most 10^9 m, the friction at most 10^12.
/// @return non_finite_value or invalid_argument; the text names the fault. Thread-safe.
[[nodiscard]] SUNDER_API Status validate_collider(const Collider& collider);

}  // namespace sunder
