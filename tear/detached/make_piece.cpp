#include "tear/detached/make_piece.h"

#include <utility>

#include "core/internal/ordered.h"
#include "tear/detached/piece_pose.h"

namespace sunder::tear {
namespace {

/// Name of the bone of a frozen piece.
constexpr const char* kBone = "piece";

/// Moves along the axes of a frame.
template <class Vector>
Vec3f into_frame(const Affine3d& model_from_piece, const Vector& direction) {
  const Vec3d in_model(static_cast<double>(direction[0]), static_cast<double>(direction[1]),
                       static_cast<double>(direction[2]));
  const Mat3d piece_from_model = model_from_piece.linear().transpose();
  return Vec3d(multiply(piece_from_model, in_model)).template cast<float>();
}

/// Puts the posed vertices into bind space, where nothing but one bone moves them.
void freeze(const PosedPieceMesh& posed, const Vec3d& origin, const Affine3d& model_from_piece,
            Mesh& mesh) {
  const Mat3d piece_from_model = model_from_piece.linear().transpose();
  const Vec3d shift = origin - model_from_piece.translation();
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3d from_centre = posed.positions[v].cast<double>() + shift;
    mesh.positions[v] = Vec3d(multiply(piece_from_model, from_centre)).cast<float>();
  }
  for (std::size_t v = 0; v < mesh.normals.size(); ++v)
    mesh.normals[v] = normalized(into_frame(model_from_piece, posed.normals[v]));
  for (std::size_t v = 0; v < mesh.tangents.size(); ++v)
    mesh.tangents[v].head<3>() = normalized(into_frame(model_from_piece, posed.tangents[v]));
  mesh.weights = {};
  mesh.weights.first.reserve(mesh.vertex_count() + std::size_t{1});
  mesh.weights.influences.reserve(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    mesh.weights.append(std::array<Influence, 1>{{{0, 1.0f}}});
  mesh.morph_targets.clear();
  mesh.first_morph_weight = 0;
}

void write_frozen(PieceMeshes& meshes, const PiecePose& posed, const Affine3d& model_from_piece,
                  const Character& model, Character& character) {
  BoneTransform rest;
  rest.translation = model_from_piece.translation().cast<float>();
  const Mat3d axes = model_from_piece.linear();
  rest.rotation = normalized(Quatd(axes)).cast<float>();
  character.skeleton.bones.push_back({kBone, kNone, rest});
  // Meshes with different skins stay apart where they touch.
  for (const Index skin : meshes.skins)
    character.skins.push_back({model.skins[skin].name, {0}, {Affine3f::Identity()}});
  for (std::size_t i = 0; i < meshes.meshes.size(); ++i)
    freeze(posed.meshes[i], posed.origin, model_from_piece, meshes.meshes[i]);
}

void write_animated(PieceMeshes& meshes, const Character& model, Character& character) {
  character.skeleton = model.skeleton;
  character.rest_morph_weights = model.rest_morph_weights;
  character.clips = model.clips;
  for (Index skin = 0; skin < meshes.skins.size(); ++skin)
    character.skins.push_back(reduce_skin(model.skins[meshes.skins[skin]], skin, meshes.meshes));
}

}  // namespace

Result<DetachedPiece> make_piece(const std::vector<Index>& faces, const ModelPose& pose,
                                 const DetachOptions& options, const SurfaceEditor& editor) {
  DetachedPiece piece;
  if (options.motion == PieceMotion::none) return piece;
  PieceMeshes meshes = copy_meshes(faces, editor);
  const Result<PiecePose> posed = pose_piece(meshes, pose, editor);
  if (!posed) return posed.error();
  const Result<MassProperties> mass = mass_of(meshes, *posed, options.mass);
  if (!mass) return mass.error();
  piece.mass = *mass;
  piece.inertia_piece = mass->inertia;
  Character character;
  character.name = editor.character().name;
  if (options.motion == PieceMotion::frozen) {
    piece.model_from_piece.translation() = mass->centre;
    if (options.axes == PieceAxes::principal) {
      const PrincipalAxes principal = principal_axes(mass->inertia);
      piece.model_from_piece.linear() = principal.axes;
      piece.inertia_piece = principal.moments.asDiagonal();
    }
    write_frozen(meshes, *posed, piece.model_from_piece, editor.character(), character);
  } else {
    write_animated(meshes, editor.character(), character);
  }
  character.meshes = std::move(meshes.meshes);
  piece.meshes = std::move(meshes.maps);
  piece.points = std::move(meshes.points);
  piece.character = std::make_shared<const Character>(std::move(character));
  return piece;
}

}  // namespace sunder::tear
