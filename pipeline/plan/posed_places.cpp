#include "pipeline/plan/posed_places.h"

#include <sunder/skinning/deform.h>

#include <cmath>
#include <map>
#include <utility>

namespace sunder::plan {
namespace {

constexpr double kSumError = 1e-6;  ///< Of barycentric coordinates.

Vec3d bind_position(const Mesh& mesh, std::uint32_t vertex, std::span<const float> morph_weights) {
  Vec3d place = mesh.positions[vertex].cast<double>();
  for (std::size_t target = 0; target < mesh.morph_targets.size(); ++target) {
    const std::vector<Vec3f>& deltas = mesh.morph_targets[target].position_deltas;
    const float weight = morph_weights[mesh.first_morph_weight + target];
    if (!deltas.empty() && weight != 0) place += weight * deltas[vertex].cast<double>();
  }
  return place;
}

Vec3d skinned(const Mesh& mesh, std::uint32_t vertex, const std::vector<Affine3d>& model_from_bind,
              std::span<const float> morph_weights) {
  const Vec3d bind = bind_position(mesh, vertex, morph_weights);
  Vec3d place = Vec3d::Zero();
  for (const Influence& influence : mesh.weights.of(vertex))
    place += static_cast<double>(influence.weight) * (model_from_bind[influence.slot] * bind);
  return place;
}

}  // namespace

PosedPlaces::PosedPlaces(const Character& character, std::span<const SurfaceAnchor> places)
    : character_(character) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
  for (const SurfaceAnchor& anchor : places) {
    Place place{{}, anchor.birth.barycentric};
    const Triangle& triangle = character.meshes[anchor.mesh].triangles[anchor.birth.triangle];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto next = static_cast<std::uint32_t>(corners_.size());
      const auto [found, is_new] = known.emplace(std::pair(anchor.mesh, triangle[i]), next);
      if (is_new) corners_.push_back({anchor.mesh, triangle[i]});
      place.corners[i] = found->second;
    }
    places_.push_back(place);
  }
}

Status PosedPlaces::pose(const ModelPose& pose, std::span<Vec3d> places,
                         std::span<Vec3d> normals) const {
  std::map<std::uint32_t, std::vector<Affine3d>> palettes;  // by skin
  std::vector<Vec3d> posed;
  posed.reserve(corners_.size());
  for (const Corner& corner : corners_) {
    const Mesh& mesh = character_.meshes[corner.mesh];
    const auto [palette, is_new] = palettes.try_emplace(mesh.skin);
    if (is_new) {
      const Skin& skin = character_.skins[mesh.skin];
      palette->second.resize(skin.bones.size());
      if (const Status status = compute_palette(skin, pose, palette->second); !status)
        return status;
    }
    posed.push_back(skinned(mesh, corner.vertex, palette->second, pose.morph_weights));
  }
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Vec3d &a = posed[places_[i].corners[0]], &b = posed[places_[i].corners[1]],
                &c = posed[places_[i].corners[2]];
    const std::array<double, 3>& share = places_[i].barycentric;
    places[i] = share[0] * a + share[1] * b + share[2] * c;
    if (normals.empty()) continue;
    const Vec3d normal = (b - a).cross(c - a);
    const double length = normal.norm();
    normals[i] = length > 0 ? Vec3d(normal / length) : Vec3d::Zero();
  }
  return {};
}

Status check_place(const Character& character, const SurfaceAnchor& place, std::uint32_t index) {
  if (place.mesh >= character.meshes.size())
    return Status::failure(StatusCode::index_out_of_range, index,
                           "place %u: mesh %u does not exist; the character has %zu", index,
                           place.mesh, character.meshes.size());
  const Mesh& mesh = character.meshes[place.mesh];
  if (place.birth.triangle >= mesh.triangle_count())
    return Status::failure(StatusCode::index_out_of_range, index,
                           "place %u: triangle %u does not exist; mesh %u has %u", index,
                           place.birth.triangle, place.mesh, mesh.triangle_count());
  double sum = 0;
  for (const double share : place.birth.barycentric) {
    if (!std::isfinite(share))
      return Status::failure(StatusCode::non_finite_value, index,
                             "place %u: a barycentric coordinate is not finite", index);
    if (share < -kSumError)
      return Status::failure(StatusCode::invalid_argument, index,
                             "place %u: barycentric coordinate %g is below 0", index, share);
    sum += share;
  }
  if (std::abs(sum - 1) > kSumError)
    return Status::failure(StatusCode::invalid_argument, index,
                           "place %u: barycentric coordinates have the sum %g; expected 1", index,
                           sum);
  return {};
}

}  // namespace sunder::plan
