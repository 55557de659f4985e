#pragma once

#include <sunder/tear/detached_piece.h>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// The meshes of a piece as the torn model has them, and which skins they use.
struct PieceMeshes {
  std::vector<DetachedPiece::OfMesh> maps;
  std::vector<Mesh> meshes;   ///< Mesh::skin is an index in `skins`; slots are those of the model.
  std::vector<Index> skins;   ///< Of the model, ascending.
  std::vector<Index> points;  ///< Of the model, ascending.
};

/// @param faces  ascending. O(faces), and two bits per vertex of the mesh; memory for an index per
/// vertex. @throws std::bad_alloc
[[nodiscard]] PieceMeshes copy_meshes(const std::vector<Index>& faces, const SurfaceEditor& editor);

/// The positions per influence of those vertices of a piece's mesh that have some.
/// @param of  of the mesh of the model. @throws std::bad_alloc
[[nodiscard]] InfluencePositions copy_exact(const InfluencePositions& of,
                                            const SkinWeights& weights,
                                            const std::vector<Index>& vertex_old_from_new);

/// Reduces a skin to the slots that some meshes use, and renumbers their influences.
/// @return the bones and binds that stay, in order.
[[nodiscard]] Skin reduce_skin(const Skin& skin, Index index, std::vector<Mesh>& meshes);

}  // namespace sunder::tear
