#pragma once

#include <sunder/bodies/convex_hulls.h>
#include <sunder/bodies/mass_properties.h>
#include <sunder/tear/torn_model.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace sunder {

/// How a detached piece moves.
enum class PieceMotion : std::uint8_t {
  frozen,    ///< As one rigid body, in the shape that it had in the pose of the detachment.
  animated,  ///< By the bones, clips and morph targets of the model that it came from.
  none,      ///< The piece vanishes; no character is made.
};

/// The axes of a frozen piece.
enum class PieceAxes : std::uint8_t {
  principal,  ///< Those in which its tensor of inertia is diagonal, ascending.
  model,      ///< Those of model space.
};

struct DetachOptions {
  PieceMotion motion = PieceMotion::frozen;
  PieceAxes axes = PieceAxes::principal;  ///< Of a frozen piece.
  MassOptions mass;
};

/// A piece that came free of a TornModel: a character of its own with the piece's vertices and
/// triangles, bit for bit and in their order, with their submeshes and materials.
struct DetachedPiece {
  /// The origin of the elements of one mesh. New indices are the places in the arrays.
  struct OfMesh {
    std::uint32_t mesh = 0;                            ///< In the torn model.
    std::vector<std::uint32_t> vertex_old_from_new;    ///< Ascending.
    std::vector<std::uint32_t> triangle_old_from_new;  ///< Ascending.
    /// Per triangle: the surface points that the torn model had at its corners.
    std::vector<std::array<std::uint32_t, 3>> old_points;
    /// Per triangle: the bone of the torn model that moves it most.
    std::vector<std::uint32_t> bones;
  };

  /// Frozen: one bone, whose frame has its origin at the centre of mass; bind space is that frame,
  /// and the rest pose stands where the piece was. No clips, no morph targets. Animated: the
  /// skeleton, clips and morph weights of the model, so the same poses fit; skins have the bones
  /// that move the piece. Null for PieceMotion::none.
  std::shared_ptr<const Character> character;
  std::vector<OfMesh> meshes;         ///< One per mesh of the character, ascending.
  std::vector<std::uint32_t> points;  ///< The surface points in `old_points`, ascending.
  /// The frame of a frozen piece in the pose of the detachment; otherwise the identity.
  Affine3d model_from_piece = Affine3d::Identity();
  /// In model space, in the pose of the detachment.
  MassProperties mass;
  /// `mass.inertia` along the axes of `model_from_piece`; for principal axes diagonal.
  Mat3d inertia_piece = Mat3d::Zero();
  TearReport report;  ///< `pieces` holds this one; indices are those of the torn model.
};

/// Takes a connected piece of the surface off a model: its triangles retire, so that no later
/// operation meets them, and the piece becomes a character of its own. docs/detach.md. Undo puts it
/// back into the model; the detached character stays as it is.
/// @param place   on the piece; the history records it as a triangle.
/// @param change  optional; written, with the vertices that are released.
/// @return as TornModel::tear(); index_out_of_range or not_found if nothing is at the place;
///         invalid_argument if nothing else is left of the model. O(piece log piece), allocates.
SUNDER_API Result<DetachedPiece> detach(TornModel& model, const ModelPose& pose,
                                        const PiecePlace& place, const DetachOptions& options = {},
                                        ChangeRecord* change = nullptr);

/// Convex hulls of a frozen piece, in its own frame, one for each part that was moved by another
/// bone, as far as the options allow. For an animated one see convex_hulls() of a character.
/// @return as that function; invalid_argument if the piece is not frozen.
[[nodiscard]] SUNDER_API Result<std::vector<ConvexHull>> convex_hulls(
    const DetachedPiece& piece, const HullOptions& options = {});

}  // namespace sunder
