#pragma once

#include <sunder/core/skeleton.h>

#include "core/internal/ordered.h"
#include "skinning/internal/rotation.h"

namespace sunder::animation {

/// (1 - t) a + t b along the shorter arc, normalised.
inline Quatf nlerp(const Quatf& a, const Quatf& b, float t) {
  const Quatf from = unit(a), to = unit(b);
  const float sign = dot(from.coeffs(), to.coeffs()) < 0.0f ? -1.0f : 1.0f;
  return unit(Quatf(Vec4f((1.0f - t) * from.coeffs() + (sign * t) * to.coeffs())));
}

/// @param t  in [0, 1]; 0 and 1 keep the bits of one side.
inline void blend_transform(const BoneTransform& other, float t, BoneTransform& transform) {
  if (t <= 0.0f) return;
  if (t >= 1.0f) {
    transform = other;
    return;
  }
  transform.translation += t * (other.translation - transform.translation);
  transform.scale += t * (other.scale - transform.scale);
  if (transform.rotation.coeffs() != other.rotation.coeffs())
    transform.rotation = nlerp(transform.rotation, other.rotation, t);
}

inline BoneTransform delta_of(const BoneTransform& transform, const BoneTransform& reference) {
  BoneTransform delta;
  delta.translation = transform.translation - reference.translation;
  if (transform.rotation.coeffs() != reference.rotation.coeffs())
    delta.rotation = unit(multiply(conjugate(unit(reference.rotation)), unit(transform.rotation)));
  for (int axis = 0; axis < 3; ++axis)
    delta.scale[axis] =
        reference.scale[axis] == 0.0f ? 1.0f : transform.scale[axis] / reference.scale[axis];
  return delta;
}

inline void add_transform(const BoneTransform& delta, float t, BoneTransform& transform) {
  if (t <= 0.0f) return;
  transform.translation += t * delta.translation;
  if (delta.rotation.coeffs() != Quatf::Identity().coeffs())
    transform.rotation =
        unit(multiply(unit(transform.rotation), nlerp(Quatf::Identity(), delta.rotation, t)));
  for (int axis = 0; axis < 3; ++axis)
    transform.scale[axis] *= 1.0f + t * (delta.scale[axis] - 1.0f);
}

}  // namespace sunder::animation
