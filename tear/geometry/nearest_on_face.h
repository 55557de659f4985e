#pragma once

#include <sunder/core/math.h>

#include <algorithm>

#include "core/internal/ordered.h"

namespace sunder::tear {

/// The point of a segment nearest to a place.
inline Vec3d nearest_on_segment(const Vec3d& place, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = b - a;
  const double square = squared_norm(along);
  const double part = square > 0 ? std::clamp(dot(Vec3d(place - a), along) / square, 0.0, 1.0) : 0;
  return a + part * along;
}

/// The point of a triangle nearest to a place; triangles without area count as their edges.
inline Vec3d nearest_on_face(const Vec3d& place, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = (b - a).cross(c - a);
  const double square = squared_norm(normal);
  const auto is_inside = [&](const Vec3d& from, const Vec3d& to) {
    return dot(normal, Vec3d((to - from).cross(place - from))) >= 0;
  };
  if (square > 0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a))
    return place - dot(Vec3d(place - a), normal) / square * normal;
  Vec3d nearest = nearest_on_segment(place, a, b);
  for (const Vec3d& other : {nearest_on_segment(place, b, c), nearest_on_segment(place, c, a)})
    if (squared_norm(Vec3d(other - place)) < squared_norm(Vec3d(nearest - place))) nearest = other;
  return nearest;
}

}  // namespace sunder::tear
