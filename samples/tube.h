#pragma once

#include <sunder/core/character.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace samples {

struct TubeShape {
  std::uint32_t around = 16, along = 20;  ///< Squares.
  float radius = 0.15f;                   ///< Metres.
  bool has_uvs = false;  ///< Duplicates the first column of vertices at the seam of the texture.
};

/// A tube of one metre along y, open at both ends, with all arrays that skinning and tearing need.
inline sunder::Mesh make_tube_mesh(const TubeShape& shape) {
  sunder::Mesh mesh;
  mesh.name = "Tube";
  if (shape.has_uvs) mesh.uv_sets.emplace_back();
  const std::uint32_t columns = shape.around + (shape.has_uvs ? 1 : 0);
  for (std::uint32_t ring = 0; ring <= shape.along; ++ring)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const float turn = static_cast<float>(i % shape.around) / static_cast<float>(shape.around);
      const float angle = 2 * std::numbers::pi_v<float> * turn;
      const float height = static_cast<float>(ring) / static_cast<float>(shape.along);
      mesh.positions.emplace_back(shape.radius * std::sin(angle), height,
                                  shape.radius * std::cos(angle));
      mesh.normals.emplace_back(std::sin(angle), 0.0f, std::cos(angle));
      if (shape.has_uvs)
        mesh.uv_sets[0].emplace_back(static_cast<float>(i) / static_cast<float>(shape.around),
                                     height);
      // The upper bone takes over within 0.2 m around the joint. Weights of zero are left out.
      const float upper = std::clamp((height - 0.4f) / 0.2f, 0.0f, 1.0f);
      const sunder::Influence both[] = {{0, 1.0f - upper}, {1, upper}};
      const std::size_t first = upper == 1.0f ? 1 : 0, end = upper == 0.0f ? 1 : 2;
      mesh.weights.append({both + first, end - first});
    }
  for (std::uint32_t ring = 0; ring < shape.along; ++ring)
    for (std::uint32_t i = 0; i < shape.around; ++i) {
      const std::uint32_t a = ring * columns + i, b = ring * columns + (i + 1) % columns;
      mesh.triangles.push_back({a, b, b + columns});
      mesh.triangles.push_back({a, b + columns, a + columns});
    }
  mesh.submeshes.push_back({"Rubber", sunder::kNone});
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  return mesh;
}

/// The tube on two bones with a joint in the middle.
inline sunder::Character make_tube(const TubeShape& shape = {}) {
  sunder::Character character;
  sunder::BoneTransform at_joint;
  at_joint.translation = {0, 0.5f, 0};
  character.skeleton.bones = {{"lower", sunder::kNone, {}}, {"upper", 0, at_joint}};
  // The skin is attached in the rest pose: bone_from_bind is the inverse of it.
  sunder::Affine3f upper_from_bind = sunder::Affine3f::Identity();
  upper_from_bind.translation() = -at_joint.translation;
  character.skins = {{"Tube", {0, 1}, {sunder::Affine3f::Identity(), upper_from_bind}}};
  character.meshes = {make_tube_mesh(shape)};
  return character;
}

/// The tube bent forward at its joint; radians.
inline sunder::ModelPose bent(const sunder::Character& tube, double angle) {
  auto pose = local_rest_pose(tube);
  if (!pose) std::abort();
  pose->parent_from_bone[1].rotation =
      sunder::Quatf(Eigen::AngleAxisf(static_cast<float>(angle), Eigen::Vector3f::UnitX()));
  sunder::ModelPose model_pose;
  if (!compute_model_pose(tube.skeleton, *pose, model_pose)) std::abort();
  return model_pose;
}

}  // namespace samples
