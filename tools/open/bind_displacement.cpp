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

/// Carries what changed in one mesh back, vertex by vertex.
class CarryBack {
 public:
  CarryBack(const Mesh& mesh, const ModelPose& pose) : mesh_(mesh), pose_(pose) {
    const Vec3f none = Vec3f::Zero();
    target_.position_deltas.assign(mesh.positions.size(), none);
    if (!mesh.normals.empty()) target_.normal_deltas.assign(mesh.positions.size(), none);
    if (!mesh.tangents.empty()) target_.tangent_deltas.assign(mesh.positions.size(), none);
  }

  void carry(std::uint32_t vertex, const BindSpace::Blended& blended, const DeformedMesh& from,
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

Result<BindSpace> BindSpace::create(const Character& character, std::uint32_t mesh,
                                    const ModelPose& pose) {
  BindSpace bind;
  bind.weights_ = &character.meshes[mesh].weights;
  const Skin& skin = character.skins[character.meshes[mesh].skin];
  bind.palette_.resize(skin.bones.size());
  if (const Status status = compute_palette(skin, pose, bind.palette_); !status) return status;
  for (const Affine3d& matrix : bind.palette_)
    bind.normal_matrices_.push_back(compute_normal_matrix(matrix.linear()));
  return bind;
}

BindSpace::Blended BindSpace::at(std::uint32_t vertex) const {
  Blended blended;
  for (const Influence& influence : weights_->of(vertex)) {
    const double weight = influence.weight;
    blended.of_positions += weight * palette_[influence.slot].linear();
    blended.of_normals += weight * normal_matrices_[influence.slot];
  }
  return blended;
}

Vec3f BindSpace::displacement(std::uint32_t vertex, const Vec3f& posed) const {
  const std::optional<Mat3d> back = inverse_of(at(vertex).of_positions);
  return back ? Vec3f((*back * posed.cast<double>()).cast<float>()) : Vec3f(Vec3f::Zero());
}

Vec3f BindSpace::normal(std::uint32_t vertex, const Vec3f& posed) const {
  const std::optional<Mat3d> back = inverse_of(at(vertex).of_normals);
  if (!back) return posed;
  const Vec3d normal = *back * posed.cast<double>();
  return normal.norm() > 0 ? Vec3f(normal.normalized().cast<float>()) : posed;
}

Result<MorphTarget> displacement_in_bind(const Character& character, std::uint32_t mesh_index,
                                         const ModelPose& pose, const DeformedMesh& from,
                                         const DeformedMesh& to) {
  if (from.positions == to.positions) return MorphTarget();
  const Mesh& mesh = character.meshes[mesh_index];
  const Result<BindSpace> bind = BindSpace::create(character, mesh_index, pose);
  if (!bind) return bind.error();
  CarryBack back(mesh, pose);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const bool is_moved = from.positions[v] != to.positions[v] ||
                          (!to.normals.empty() && from.normals[v] != to.normals[v]) ||
                          (!to.tangents.empty() && from.tangents[v] != to.tangents[v]);
    if (is_moved) back.carry(v, bind->at(v), from, to);
  }
  return back.finish();
}

}  // namespace sunder::tools
