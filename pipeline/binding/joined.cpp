#include "pipeline/binding/joined.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"

namespace sunder::binding {
namespace {

bool is_invertible(const Affine3d& matrix) {
  if (!matrix.matrix().allFinite()) return false;
  const double largest = matrix.linear().cwiseAbs().maxCoeff();
  return std::abs(determinant(matrix.linear())) > 1e-12 * largest * largest * largest;
}

/// A robot without visual meshes is a rig too, which validate_character() alone would refuse.
Status check_rig(const Character& rig) {
  if (!rig.meshes.empty()) return validate_character(rig);
  if (rig.skeleton.bones.empty())
    return Status::failure(StatusCode::empty_input, kNone, "the rig has no bone");
  Character with_mesh = rig;
  with_mesh.skins.push_back({"", {0}, {Affine3f::Identity()}});
  with_mesh.meshes.emplace_back().skin = static_cast<Index>(with_mesh.skins.size() - 1);
  return validate_character(with_mesh);
}

Status check_place(const Character& rig, const BindingPlace& place) {
  if (!is_invertible(place.rig_from_model))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the place of the model has no inverse");
  const std::size_t count = rig.skeleton.bones.size();
  if (!place.rig_from_bone.empty() && place.rig_from_bone.size() != count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose of the rig has %zu bones, the rig has %zu",
                           place.rig_from_bone.size(), count);
  return {};
}

/// The matrix by which a skin carries its meshes into the model's space at bind: that of its first
/// slot with an inverse, because the others agree unless skins bind a bone differently.
Affine3d model_from_bind(const Skin& skin, const std::vector<Affine3d>& palette) {
  for (std::size_t slot = 0; slot < palette.size(); ++slot)
    if (is_invertible(Affine3d(skin.bone_from_bind[slot].cast<double>()))) return palette[slot];
  return palette.front();
}

/// Places the vertices of a mesh, and measures how far the skin's one matrix puts them elsewhere.
void place_mesh(const Mesh& mesh, const std::vector<Affine3d>& palette, Joined& joined) {
  const Affine3d& as_bound = joined.rig_from_bind[mesh.skin];
  std::vector<Vec3d>& positions = joined.positions.emplace_back();
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3d bind = mesh.positions[v].cast<double>();
    Vec3d posed = Vec3d::Zero();
    double sum = 0;
    for (const Influence& influence : mesh.weights.of(v)) {
      const auto weight = static_cast<double>(influence.weight);
      posed += weight * transform(palette[influence.slot], bind);
      sum += weight;
    }
    positions.push_back(transform(as_bound, bind));
    joined.largest_shape_error =
        std::max(joined.largest_shape_error, norm(Vec3d(posed / sum - positions.back())));
  }
}

void place_model(const BindingPlace& place, Joined& joined) {
  const Character& model = joined.model;
  const ModelPose bind = or_throw(bind_pose(model));
  for (const Affine3d& model_from_bone : bind.model_from_bone)
    joined.rig_from_model_bone.push_back(multiply(place.rig_from_model, model_from_bone));
  std::vector<std::vector<Affine3d>> palettes;
  for (const Skin& skin : model.skins) {
    auto& palette = palettes.emplace_back(skin.bones.size());
    or_throw(compute_palette(skin, bind, palette));
    joined.rig_from_bind.push_back(multiply(place.rig_from_model, model_from_bind(skin, palette)));
    for (Affine3d& matrix : palette) matrix = multiply(place.rig_from_model, matrix);
  }
  for (const Mesh& mesh : model.meshes) place_mesh(mesh, palettes[mesh.skin], joined);
}

}  // namespace

Result<Joined> join(const Character& model, const Character& rig, const BindingPlace& place) {
  for (const Status& status : {validate_character(model), check_rig(rig), check_place(rig, place)})
    if (!status) return status;
  Joined joined{model, rig, place.rig_from_bone, {}, {}, {}, 0};
  if (joined.rig_from_bone.empty()) joined.rig_from_bone = or_throw(rest_pose(rig)).model_from_bone;
  for (Index bone = 0; bone < joined.rig_from_bone.size(); ++bone)
    if (!joined.rig_from_bone[bone].matrix().allFinite())
      return Status::failure(StatusCode::non_finite_value, bone,
                             "the pose of the rig: bone %u '%.80s' is not finite", bone,
                             rig.skeleton.bones[bone].name.c_str());
  place_model(place, joined);
  return joined;
}

}  // namespace sunder::binding
