#include "bench/skinning/skinning_scene.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/skinned_mesh.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "bench/harness/subdivided_model.h"
#include "bench/peers/native_peers.h"
#include "skinning/internal/reference.h"
#include "support/models/rigs.h"

namespace sunder::bench {
namespace {

void require(const Status& status) {
  if (!status) std::abort();
}

SkinnedMesh make_mesh(const SkinningScene& scene) {
  Result<SkinnedMesh> mesh =
      SkinnedMesh::create(source_of(scene.mesh()), scene.character.skins[0].bones.size());
  require(mesh.error());
  return std::move(*mesh);
}

}  // namespace

LineFloats::LineFloats(std::size_t count)
    : data_(
          static_cast<float*>(::operator new((count + 16) * sizeof(float), std::align_val_t(64)))) {
  std::memset(data_.get(), 0, (count + 16) * sizeof(float));
}

SkinningScene::SkinningScene(int divisions, bool ordered)
    : character(make_subdivided_model(divisions, 64)) {
  Mesh& mesh = character.meshes[0];
  if (ordered) require(reorder_vertices(mesh, *order_for_skinning(mesh)));
  test::Random random(1);
  for (std::size_t i = 0; i < kPoses; ++i) {
    poses[i] = test::random_pose(character, random, 0.6, 1.0);
    matrices[i].resize(character.skins[0].bones.size());
    require(compute_palette(character.skins[0], poses[i], std::span(matrices[i])));
  }
}

CrowdMember::CrowdMember(const SkinningScene& scene, SkinningMethod method)
    : vertices(scene.vertex_count()),
      mesh(make_mesh(scene)),
      in(mesh.stream_bytes() / sizeof(float)),
      positions(3 * vertices),
      normals(3 * vertices),
      tangents(4 * vertices),
      interleaved(6 * vertices),
      bind_positions(3 * vertices),
      bind_normals(3 * vertices),
      slots(4 * vertices),
      weights(4 * vertices),
      buffer({vertices, {positions.data()}, {normals.data()}, {}}) {
  for (std::size_t i = 0; i < SkinningScene::kPoses; ++i) {
    palettes.push_back(*BonePalette::create(scene.character.skins[0].bones.size(),
                                            scene.character.rest_morph_weights.size(), method));
    require(palettes.back().set(scene.character.skins[0], scene.poses[i]));
  }
  for (std::uint32_t v = 0; v < vertices; ++v) {
    std::memcpy(bind_positions.data() + 3 * v, scene.mesh().positions[v].data(), 12);
    std::memcpy(bind_normals.data() + 3 * v, scene.mesh().normals[v].data(), 12);
    const auto influences = scene.mesh().weights.of(v);
    for (std::size_t k = 0; k < influences.size(); ++k) {
      slots[4 * v + k] = static_cast<std::uint16_t>(influences[k].slot);
      weights[4 * v + k] = influences[k].weight;
    }
  }
}

void CrowdMember::pose_by_eigen(const SkinningScene& scene, std::size_t pose) {
  skin_by_eigen(vertices, bind_positions.data(), bind_normals.data(), slots.data(), weights.data(),
                scene.matrices[pose][0].data(), positions.data(), normals.data());
}

void CrowdMember::pose_by_ours(std::size_t pose, PosedBuffer& to, const ParallelFor& parallel_for) {
  require(mesh.deform(palettes[pose], to, parallel_for));
}

SkinningError error_of(const SkinningScene& scene, std::size_t pose, const float* positions,
                       const float* normals) {
  std::vector<Affine3d> palette(scene.matrices[pose].size());
  require(compute_palette(scene.character.skins[0], scene.poses[pose], std::span(palette)));
  const double scale = 2.0 / test::posed_diagonal(scene.character, scene.poses[pose]);
  SkinningError error;
  for (std::uint32_t v = 0; v < scene.vertex_count(); ++v) {
    const Vec3d position =
        deform_position_reference(scene.mesh(), v, palette, scene.poses[pose].morph_weights);
    const Vec3d found = Eigen::Map<const Eigen::Vector3f>(positions + 3 * v).cast<double>();
    error.position = std::max(error.position, scale * (found - position).norm());
    const Vec3d normal =
        deform_normal_reference(scene.mesh(), v, palette, scene.poses[pose].morph_weights);
    const Vec3d found_normal =
        Eigen::Map<const Eigen::Vector3f>(normals + 3 * v).cast<double>().normalized();
    error.normal = std::max(error.normal, (found_normal - normal).norm());
  }
  return error;
}

}  // namespace sunder::bench
