#pragma once

#include <sunder/tear/wound_mask.h>

#include <span>
#include <string>
#include <vector>

#include "tools/picture/model_looks.h"
#include "tools/render/image.h"

namespace sunder::tools {

/// The base colour of a submesh with blood on it.
struct BloodTexture {
  std::uint32_t mesh = 0, submesh = 0;
  std::uint32_t material = kNone;  ///< Of the source; kNone: none.
  Image image;                     ///< The factor of the base colour is part of it.
  std::uint32_t uv_set = 0;
  /// Where in the image a place (u, v, 1) of the texture coordinates is.
  Eigen::Matrix<float, 2, 3> image_from_uv = Eigen::Matrix<float, 2, 3>::Identity();
  bool is_placed_anew = false;  ///< Whether the source's own image is elsewhere.
};

/// Blood on a mesh that has no room for it in a texture.
struct BloodTints {
  std::uint32_t mesh = 0;
  std::vector<Vec3f> tints;  ///< Per vertex of the torn mesh: factors of its colour, linear RGB.
};

/// What shows blood on a torn model.
struct BloodLayers {
  std::vector<BloodTexture> textures;
  std::vector<BloodTints> tints;
  std::vector<std::string> notes;  ///< Why meshes have tints, in sentences.
};

struct BloodOptions {
  /// How far from lips there is blood, metres in the pose; the mask of each mesh has it in bind
  /// space, which may have another scale.
  double reach = 0;
  const ModelPose* flow_pose = nullptr;  ///< In which blood runs down; null: it does not.
  /// For all textures together, so that a file cannot ask for more.
  std::uint64_t most_pixels = kMostImagePixels;
};

/// The reach that suits a model of this size.
/// @param diagonal  of its surface in the pose, metres.
[[nodiscard]] double blood_reach(double diagonal);

/// How blood runs that suits this reach.
[[nodiscard]] BloodFlowOptions flow_within(double reach);

/// Metres in bind space per metre in a pose, on the mean over a mesh; 0 if it has no area.
[[nodiscard]] double bind_scale(const Mesh& mesh, const DeformedMesh& posed);

/// Lays blood around the wounds of a model on copies of the textures of torn meshes; on the colours
/// of their vertices where a submesh has no texture coordinates, shares texels between triangles
/// that see a wound, or has an image that cannot be read or would be too large.
/// @param source  the meshes of the model's source in a pose.
/// @param looks   of the model's source document.
/// @return the failures of WoundMask::create().
[[nodiscard]] Result<BloodLayers> lay_blood(const TornModel& model,
                                            std::span<const DeformedMesh> source,
                                            const ModelLooks& looks, const BloodOptions& options);

}  // namespace sunder::tools
