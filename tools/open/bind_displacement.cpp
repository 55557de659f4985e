#include "tools/open/bind_displacement.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/LU>

namespace sunder::tools {
namespace {

/// A blend of bones is taken for flat if its volume is less than this share of a cube's with edges
/// of the same length.
constexpr double kFlat = 1e-5;

std::optional<Mat3d> inverse_of(const Mat3d& linear) {
  const double size = linear.norm() / std::sqrt(3.0);
  if (!(std::abs(linear.determinant()) > kFlat * size * size * size)) return std::nullopt;
  return Mat3d(linear.inverse());
}

/// The linear parts by which skinning moves the positions and the normals of a vertex.
struct Blended {
  Mat3d of_positions = Mat3d::Zero(), of_normals = Mat3d::Zero();
};

Blended blend(std::span<const Influence> influences, const std::vector<Affine3d>& palette,
              const std::vector<Mat3d>& normal_matrices) {
  Blended blended;
  for (const Influence& influence : influences) {
    const double weight = influence.weight;
    blended.of_positions += weight * palette[influence.slot].linear();
    blended.of_normals += weight * normal_matrices[influence.slot];
  }
  return blended;
}

/// Carries what changed in one mesh back, vertex by vertex.
class CarryBack {
 public:
  CarryBack(const Mesh& mesh, const ModelPose& pose) : mesh_(mesh), pose_(pose) {
    const Vec3f none = Vec3f::Zero();
    target_.position_deltas.assign(mesh.positions.size(), none);
    if (!mesh.normals.empty()) target_.normal_deltas.assign(mesh.positions.size(), none);
    if (!mesh.tangents.empty()) target_.tangent_deltas.assign(mesh.positions.size(), none);
  }

  void carry(std::uint32_t vertex, const Blended& blended, const DeformedMesh& from,
             const DeformedMesh& to) {
    const std::optional<Mat3d> back = inverse_of(blended.of_positions);
    if (!back) return;
    target_.position_deltas[vertex] =
        (*back * (to.positions[vertex] - from.positions[vertex]).cast<double>()).cast<float>();
    const bool has_normal = !target_.normal_deltas.empty() && !to.normals.empty() &&
                            to.normals[vertex] != from.normals[vertex];
    if (has_normal)
      if (const std::optional<Mat3d> normal_back = inverse_of(blended.of_normals))
        target_.normal_deltas[vertex] =
            turned(mesh_.normals[vertex], vertex, &MorphTarget::normal_deltas,
                   *normal_back * to.normals[vertex].cast<double>());
    const bool has_tangent = !target_.tangent_deltas.empty() && !to.tangents.empty() &&
                             to.tangents[vertex] != from.tangents[vertex];
    if (has_tangent)
      target_.tangent_deltas[vertex] =
          turned(mesh_.tangents[vertex].head<3>(), vertex, &MorphTarget::tangent_deltas,
                 *back * to.tangents[vertex].head<3>().cast<double>());
  }

  MorphTarget finish() { return std::move(target_); }

 private:
  /// What turns a direction of bind space, as the pose's morph weights have it, to another one.
  Vec3f turned(const Vec3f& direction, std::uint32_t vertex,
               std::vector<Vec3f> MorphTarget::*deltas, const Vec3d& wanted) const {
    Vec3d now = direction.cast<double>();
    for (std::size_t i = 0; i < mesh_.morph_targets.size(); ++i)
      if (const auto& of_target = mesh_.morph_targets[i].*deltas; !of_target.empty())
        now += static_cast<double>(pose_.morph_weights[mesh_.first_morph_weight + i]) *
               of_target[vertex].cast<double>();
    const double length = wanted.norm();
    if (!(length > 0)) return Vec3f::Zero();
    return Vec3d(now.norm() / length * wanted - now).cast<float>();
  }

  const Mesh& mesh_;
  const ModelPose& pose_;
  MorphTarget target_;
};

}  // namespace

Result<MorphTarget> displacement_in_bind(const Character& character, std::uint32_t mesh_index,
                                         const ModelPose& pose, const DeformedMesh& from,
                                         const DeformedMesh& to) {
  if (from.positions == to.positions) return MorphTarget();
  const Mesh& mesh = character.meshes[mesh_index];
  const Skin& skin = character.skins[mesh.skin];
  std::vector<Affine3d> palette(skin.bones.size());
  if (const Status status = compute_palette(skin, pose, palette); !status) return status;
  std::vector<Mat3d> normal_matrices;
  for (const Affine3d& matrix : palette)
    normal_matrices.push_back(compute_normal_matrix(matrix.linear()));
  CarryBack back(mesh, pose);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const bool is_moved = from.positions[v] != to.positions[v] ||
                          (!to.normals.empty() && from.normals[v] != to.normals[v]) ||
                          (!to.tangents.empty() && from.tangents[v] != to.tangents[v]);
    if (is_moved) back.carry(v, blend(mesh.weights.of(v), palette, normal_matrices), from, to);
  }
  return back.finish();
}

}  // namespace sunder::tools
