#include "tear/detached/piece_pose.h"

#include <sunder/skinning/bone_palette.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/skinned_mesh.h>

#include "skinning/internal/reference.h"

namespace sunder::tear {
namespace {

template <class Vector>
StridedFloats<float> floats_of(std::vector<Vector>& values) {
  return {values.empty() ? nullptr : values[0].data()};
}

Status pose_mesh(const Mesh& mesh, const InfluencePositions& exact, const BonePalette& palette,
                 std::size_t slots, PosedPieceMesh& posed) {
  posed.positions.resize(mesh.positions.size());
  posed.normals.resize(mesh.normals.size());
  posed.tangents.resize(mesh.tangents.size());
  VertexSource source = source_of(mesh);
  if (!exact.vertices.empty()) source.per_influence = &exact;
  const Result<SkinnedMesh> skinned = SkinnedMesh::create(source, slots, VertexGathering::none);
  if (!skinned) return skinned.error();
  PosedBuffer buffer({mesh.vertex_count(), floats_of(posed.positions), floats_of(posed.normals),
                      floats_of(posed.tangents), true});
  return skinned->deform(palette, buffer);
}

}  // namespace

Result<PiecePose> pose_piece(const PieceMeshes& piece, const ModelPose& pose,
                             const SurfaceEditor& editor) {
  const Character& character = editor.character();
  PiecePose posed;
  for (std::size_t i = 0; i < piece.meshes.size(); ++i) {
    const Mesh& mesh = piece.meshes[i];
    const Skin& skin = character.skins[piece.skins[mesh.skin]];
    if (i == 0) {
      std::vector<Affine3d> model_from_bind(skin.bones.size());
      if (Status status = compute_palette(skin, pose, model_from_bind); !status) return status;
      posed.origin = deform_position_reference(mesh, 0, model_from_bind, pose.morph_weights);
    }
    Affine3d origin = Affine3d::Identity();
    origin.translation() = posed.origin;
    Result<BonePalette> palette = BonePalette::create(skin.bones.size(), pose.morph_weights.size());
    if (!palette) return palette.error();
    if (Status status = palette->set(skin, pose, origin); !status) return status;
    const DetachedPiece::OfMesh& map = piece.maps[i];
    const InfluencePositions exact = copy_exact(
        editor.exact.of(map.mesh), character.meshes[map.mesh].weights, map.vertex_old_from_new);
    if (Status status =
            pose_mesh(mesh, exact, *palette, skin.bones.size(), posed.meshes.emplace_back());
        !status)
      return status;
  }
  return posed;
}

Result<MassProperties> mass_of(const PieceMeshes& piece, const PiecePose& posed,
                               const MassOptions& options) {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < piece.meshes.size(); ++i) {
    const auto first = static_cast<Index>(positions.size());
    for (const Vec3f& position : posed.meshes[i].positions)
      positions.push_back(position.cast<double>());
    for (const Triangle& triangle : piece.meshes[i].triangles)
      triangles.push_back({triangle[0] + first, triangle[1] + first, triangle[2] + first});
  }
  Result<MassProperties> mass = compute_mass(positions, triangles, options);
  if (mass) mass->centre += posed.origin;
  return mass;
}

}  // namespace sunder::tear
