#include <sunder/particles/collider.h>

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "particles/internal/recorded_limits.h"

namespace sunder {
namespace {

SurfaceDistance from_round(const Vec3d& away, double radius) {
  const double length = norm(away);
  return {length - radius, length > 0 ? Vec3d(away / length) : Vec3d(Vec3d::UnitX())};
}

SurfaceDistance distance_in_frame(const Collider::Sphere& sphere, const Vec3d& p) {
  return from_round(p, sphere.radius);
}

SurfaceDistance distance_in_frame(const Collider::Capsule& capsule, const Vec3d& p) {
  return from_round(
      {p.x(), p.y() - std::clamp(p.y(), -capsule.half_length, capsule.half_length), p.z()},
      capsule.radius);
}

SurfaceDistance distance_in_frame(const Collider::Box& box, const Vec3d& p) {
  const Vec3d beyond = p.cwiseAbs() - box.half_size;
  const auto signed_axis = [&](Eigen::Index axis, double length) {
    Vec3d v = Vec3d::Zero();
    v[axis] = p[axis] < 0 ? -length : length;
    return v;
  };
  Eigen::Index nearest = 0;
  if (const double inside = beyond.maxCoeff(&nearest); inside <= 0)
    return {inside, signed_axis(nearest, 1)};
  Vec3d away = Vec3d::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    if (beyond[axis] > 0) away += signed_axis(axis, beyond[axis]);
  const double length = norm(away);
  // Length 0: so close to the surface that the square of the distance underflows.
  return length > 0 ? SurfaceDistance{length, away / length}
                    : SurfaceDistance{0, signed_axis(nearest, 1)};
}

SurfaceDistance distance_in_frame(const Collider::HalfSpace&, const Vec3d& p) {
  return {p.y(), Vec3d::UnitY()};
}

}  // namespace

SurfaceDistance distance_to(const Collider& collider, const Vec3d& place) {
  const Vec3d in_frame = collider.turn.conjugate() * (place - collider.place);
  SurfaceDistance found = std::visit(
      [&](const auto& shape) { return distance_in_frame(shape, in_frame); }, collider.shape);
  found.normal = collider.turn * found.normal;
  return found;
}

Status validate_collider(const Collider& collider) {
  if (!collider.place.allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone, "its place is not finite");
  if (collider.place.cwiseAbs().maxCoeff() > particles::kMostRecordedLength)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "its place is farther than %g m from the origin",
                           particles::kMostRecordedLength);
  if (!collider.turn.coeffs().allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone, "its turn is not finite");
  if (const double length = norm(collider.turn); std::abs(length - 1) > 1e-3)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "its turn has length %g; it must be 1", length);
  if (!(collider.friction >= 0 && collider.friction <= particles::kMostRecordedForce))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "its friction is %g; it must be from 0 to %g", collider.friction,
                           particles::kMostRecordedForce);
  const auto check = [](const char* name, double value, bool may_be_zero) {
    if ((value > 0 || (may_be_zero && value == 0)) && value <= particles::kMostRecordedLength)
      return Status();
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "its %s is %g m; it must be %s 0 and at most %g", name, value,
                           may_be_zero ? "not below" : "above", particles::kMostRecordedLength);
  };
  if (const auto* sphere = std::get_if<Collider::Sphere>(&collider.shape))
    return check("radius", sphere->radius, false);
  if (const auto* capsule = std::get_if<Collider::Capsule>(&collider.shape)) {
    if (Status status = check("radius", capsule->radius, false); !status) return status;
    return check("half length", capsule->half_length, true);
  }
  if (const auto* box = std::get_if<Collider::Box>(&collider.shape))
    for (const double half : {box->half_size.x(), box->half_size.y(), box->half_size.z()})
      if (Status status = check("half size", half, false); !status) return status;
  return {};
}

}  // namespace sunder
