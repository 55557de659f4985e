#include "io/assimp/skin_check.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace sunder::assimp_import {
namespace {

constexpr double kTolerance = 1e-4;  ///< Fraction of the mesh's size.

Eigen::AlignedBox3d bounds_of(std::span<const MeshPart> parts) {
  Eigen::AlignedBox3d bounds;
  for (const MeshPart& part : parts)
    for (std::uint32_t v = 0; v < part.vertex_count(); ++v)
      bounds.extend(Eigen::Vector3d(part.position(v)));
  return bounds;
}

Vec3d apply(const Mat4d& matrix, const Vec3d& point) {
  return matrix.topLeftCorner<3, 3>() * point + matrix.topRightCorner<3, 1>();
}

/// Largest distance between a box's corners under two maps, relative to the size of the box under
/// the second.
double relative_difference(const Mat4d& a, const Mat4d& b, const Eigen::AlignedBox3d& box) {
  double largest = 0.0;
  Eigen::AlignedBox3d mapped;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d at = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
    largest = std::max(largest, (apply(a, at) - apply(b, at)).norm());
    mapped.extend(Eigen::Vector3d(apply(b, at)));
  }
  return largest / std::max(mapped.diagonal().norm(), std::numeric_limits<double>::min());
}

/// Compares the mesh with its deformation when each bone is at the inverse of its bind matrix, all
/// in float as at run time.
double reproduction_error(const SkinSlots& skin, std::span<const MeshPart> parts) {
  std::vector<Mat4d> mesh_from_mesh;
  for (const Mat4f& bone_from_mesh : skin.bone_from_mesh) {
    const Mat4d wide = bone_from_mesh.cast<double>();
    const Mat4f mesh_from_bone = Mat4d(wide.inverse()).cast<float>();
    mesh_from_mesh.push_back(mesh_from_bone.cast<double>() * wide);
  }
  double largest = 0.0;
  for (const MeshPart& part : parts) {
    for (std::uint32_t v = 0; v < part.vertex_count(); ++v) {
      const Vec3d at = part.position(v);
      Vec3d posed = Vec3d::Zero();
      for (const Influence& influence : part.weights.of(v))
        posed += static_cast<double>(influence.weight) * apply(mesh_from_mesh[influence.slot], at);
      largest = std::max(largest, (posed - at).norm());
    }
  }
  return largest;
}

}  // namespace

void check_skin(const SkinSlots& skin, std::span<const MeshPart> parts, std::uint32_t mesh_node,
                const std::string& place, const SceneTree& tree, Notes& notes) {
  const Eigen::AlignedBox3d bounds = bounds_of(parts);
  if (bounds.isEmpty() || skin.nodes.empty()) return;
  const double size = std::max(bounds.diagonal().norm(), std::numeric_limits<double>::min());

  std::vector<bool> moves(skin.nodes.size(), false);
  for (const MeshPart& part : parts)
    for (const Influence& influence : part.weights.influences) moves[influence.slot] = true;

  char text[128];
  std::snprintf(text, sizeof text,
                "in the bind pose the skin reproduces the mesh within %.1e of its size",
                reproduction_error(skin, parts) / size);
  notes.inform(place, text);

  // The rest pose is a bind pose if all bones agree on the placement of the mesh.
  const Mat4d* reference = nullptr;
  std::vector<Mat4d> model_from_mesh(skin.nodes.size());
  double deviation = 0.0;
  for (std::size_t slot = 0; slot < skin.nodes.size(); ++slot) {
    if (!moves[slot]) continue;
    model_from_mesh[slot] =
        tree[skin.nodes[slot]].model_from_node * skin.bone_from_mesh[slot].cast<double>();
    if (reference == nullptr) reference = &model_from_mesh[slot];
    deviation = std::max(deviation, relative_difference(model_from_mesh[slot], *reference, bounds));
  }
  if (deviation > kTolerance) {
    std::snprintf(text, sizeof text,
                  "rest pose differs from bind pose, by up to %.2g of the mesh's size", deviation);
    notes.inform(place, text);
  } else if (reference != nullptr && relative_difference(tree[mesh_node].model_from_node,
                                                         *reference, bounds) > kTolerance) {
    notes.inform(place, "node and skin place the mesh differently; the skin is used");
  }
}

}  // namespace sunder::assimp_import
