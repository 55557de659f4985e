#include <sunder/bodies/mass_properties.h>
#include <sunder/particles/fitted_colliders.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "particles/contact/split_parts.h"
#include "particles/internal/fitted_shape.h"

namespace sunder {
namespace {

constexpr double kThinnest = 1e-4;  ///< Metres; flat parts get a thickness.

/// Per bone: the vertices that it moves predominantly, in its frame, and the triangles between
/// them.
std::vector<particles::PartOfBone> own_parts(const Character& character) {
  std::vector<particles::PartOfBone> own(character.skeleton.bones.size());
  for (const Mesh& mesh : character.meshes) {
    const Skin& skin = character.skins[mesh.skin];
    std::vector<Index> bones(mesh.vertex_count()), places(mesh.vertex_count());
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const Index slot = std::ranges::max_element(mesh.weights.of(v), {}, &Influence::weight)->slot;
      bones[v] = skin.bones[slot];
      std::vector<Vec3d>& points = own[bones[v]].points;
      places[v] = static_cast<Index>(points.size());
      points.push_back(transform(Affine3d(skin.bone_from_bind[slot].cast<double>()),
                                 Vec3d(mesh.positions[v].cast<double>())));
    }
    for (const Triangle& corners : mesh.triangles) {
      const Index bone = bones[corners[0]];
      if (bones[corners[1]] != bone || bones[corners[2]] != bone) continue;
      own[bone].triangles.push_back({places[corners[0]], places[corners[1]], places[corners[2]]});
    }
  }
  return own;
}

/// A frame whose y axis is the longest principal axis of the points, right-handed.
Mat3d axes_of(const std::vector<Vec3d>& points) {
  Vec3d mean = Vec3d::Zero();
  for (const Vec3d& point : points) mean += point;
  mean /= static_cast<double>(points.size());
  Mat3d spread = Mat3d::Zero();
  for (const Vec3d& point : points) {
    const Vec3d offset = point - mean;
    spread += multiply(offset, offset.transpose());
  }
  const Mat3d principal = principal_axes(spread).axes;
  Mat3d axes;
  axes.col(0) = principal.col(1);
  axes.col(1) = principal.col(2);
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

/// A shape around points of the collider's frame, and its volume.
struct Fitted {
  decltype(Collider::shape) shape;
  double volume;
};

Fitted fit_box(const Vec3d& half_size) { return {Collider::Box{half_size}, 8 * half_size.prod()}; }

Fitted fit_sphere(const std::vector<Vec3d>& points) {
  double radius = kThinnest;
  for (const Vec3d& point : points) radius = std::max(radius, norm(point));
  return {Collider::Sphere{radius}, 4.0 / 3 * std::numbers::pi * radius * radius * radius};
}

double from_axis(const Vec3d& point) {
  return std::sqrt(point.x() * point.x() + point.z() * point.z());
}

Fitted fit_capsule(const std::vector<Vec3d>& points) {
  double radius = kThinnest, half_length = 0;
  for (const Vec3d& point : points) radius = std::max(radius, from_axis(point));
  for (const Vec3d& point : points) {
    const double beside = from_axis(point);
    const double cap = std::sqrt(std::max(0.0, radius * radius - beside * beside));
    half_length = std::max(half_length, std::abs(point.y()) - cap);
  }
  const double disc = std::numbers::pi * radius * radius;
  return {Collider::Capsule{radius, half_length}, disc * (2 * half_length + 4.0 / 3 * radius)};
}

}  // namespace

Collider particles::fitted_shape(std::vector<Vec3d> points, double friction) {
  const Mat3d axes = axes_of(points);
  Eigen::AlignedBox3d box;
  for (Vec3d& point : points) {
    point = multiply(axes.transpose(), point);
    box.extend(Eigen::Vector3d(point));
  }
  const Vec3d centre = box.center();
  for (Vec3d& point : points) point -= centre;
  const Vec3d half_size = Vec3d(box.sizes() / 2).cwiseMax(kThinnest);
  const std::array<Fitted, 3> all = {fit_box(half_size), fit_capsule(points), fit_sphere(points)};
  return {std::ranges::min_element(all, {}, &Fitted::volume)->shape, multiply(axes, centre),
          normalized(Quatd(axes)), friction};
}

Result<std::vector<BoneCollider>> fit_colliders(const Character& character, double friction,
                                                std::uint32_t most_per_bone) {
  return or_out_of_memory([&]() -> Result<std::vector<BoneCollider>> {
    if (!(friction >= 0) || !std::isfinite(friction))
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "friction %g; expected a number of at least 0", friction);
    if (most_per_bone == 0)
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "no shapes per bone; expected at least 1");
    std::vector<BoneCollider> colliders;
    if (character.meshes.empty()) return colliders;
    if (const Status status = validate_character(character); !status) return status;
    const std::vector<particles::PartOfBone> own = own_parts(character);
    for (Index bone = 0; bone < own.size(); ++bone) {
      if (own[bone].points.empty()) continue;
      if (most_per_bone == 1) {
        colliders.push_back({bone, particles::fitted_shape(own[bone].points, friction)});
        continue;
      }
      for (const Collider& shape : particles::split_shapes(own[bone], friction, most_per_bone))
        colliders.push_back({bone, shape});
    }
    return colliders;
  });
}

Collider posed_collider(const BoneCollider& collider, const Affine3d& model_from_bone) {
  Collider posed = collider.collider;
  posed.place = transform(model_from_bone, collider.collider.place);
  posed.turn = normalized(multiply(Quatd(Mat3d(model_from_bone.linear())), collider.collider.turn));
  return posed;
}

}  // namespace sunder
