#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>
#include <sunder/core/status.h>

#include <variant>

namespace sunder {

/// About the origin of the collider's frame.
struct Sphere {
  double radius = 1.0;  ///< Metres, > 0.
};

/// All within the radius of a piece of the frame's y axis.
struct Capsule {
  double radius = 1.0;       ///< Metres, > 0.
  double half_length = 1.0;  ///< Of the piece, metres, >= 0: it lies from -half_length to half_length.
};

/// Along the frame's axes, about its origin.
struct Box {
  Vec3d half_size = Vec3d::Ones();  ///< Metres, each > 0.
};

/// Everything below the frame's plane y = 0.
struct HalfSpace {};

/// Something hard that a SoftBody gives way to.
struct Collider {
  std::variant<Sphere, Capsule, Box, HalfSpace> shape;
  Vec3d place = Vec3d::Zero();     ///< Of its frame, model space, metres.
  Quatd turn = Quatd::Identity();  ///< Of its frame; unit length.
  double friction = 0.0;           ///< Tangential over normal force, at most; >= 0.
};

struct SurfaceDistance {
  double distance = 0.0;          ///< Metres to the collider's surface; below 0 inside.
  Vec3d normal = Vec3d::UnitY();  ///< Of the nearest place on it, outwards, unit length. Any where all are as near.
};

/// How far a place in model space is from a collider. Exact, outside and inside. The collider is unchecked.
[[nodiscard]] SUNDER_API SurfaceDistance distance_to(const Collider& collider, const Vec3d& place);

/// @return non_finite_value or invalid_argument, with what is wrong.
[[nodiscard]] SUNDER_API Status validate_collider(const Collider& collider);

}  // namespace sunder
