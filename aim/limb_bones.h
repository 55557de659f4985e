#pragma once

#include <array>
#include <vector>

#include "aim/posed_surface.h"

namespace sunder::aim {

/// What a bone is to a limb.
enum class BoneRole : std::uint8_t {
  own,     ///< The bone that the limb is named after.
  below,   ///< In the subtree of that bone.
  parent,  ///< The parent of that bone, if it moves a vertex; otherwise the next one that does.
  other,
};

/// Weights of a place on the surface, summed by role.
struct LimbShares {
  std::array<double, 4> of_role = {};

  [[nodiscard]] double own() const { return of_role[0]; }
  [[nodiscard]] double below() const { return of_role[1]; }
  [[nodiscard]] double limb() const { return of_role[0] + of_role[1]; }
  [[nodiscard]] double parent() const { return of_role[2]; }
  [[nodiscard]] double other() const { return of_role[3]; }
  void add(const LimbShares& shares, double factor) {
    for (std::size_t i = 0; i < of_role.size(); ++i) of_role[i] += factor * shares.of_role[i];
  }
};

/// The roles of all bones for one limb.
class LimbBones {
 public:
  /// @param weights  of bone_weights().
  LimbBones(const PosedSurface& surface, const std::vector<double>& weights, Index bone);

  [[nodiscard]] Index bone() const { return bone_; }
  [[nodiscard]] BoneRole role(Index bone) const { return roles_[bone]; }
  [[nodiscard]] LimbShares shares(Index point) const;
  /// Mean of the corners.
  [[nodiscard]] LimbShares shares_of_face(Index face) const;

 private:
  const PosedSurface& surface_;
  Index bone_;
  std::vector<BoneRole> roles_;  ///< Per bone of the skeleton.
};

/// Calls visit(bone, weight) for the influences of a point.
template <class Visit>
void for_each_influence(const PosedSurface& surface, Index point, Visit visit) {
  const auto [mesh, vertex] = surface.vertex(point);
  if (mesh == kNone) return;
  const Mesh& of = surface.character().meshes[mesh];
  const Skin& skin = surface.character().skins[of.skin];
  for (const Influence& influence : of.weights.of(vertex))
    visit(skin.bones[influence.slot], static_cast<double>(influence.weight));
}

/// Per bone, the sum of its weights over all points with faces.
[[nodiscard]] std::vector<double> bone_weights(const PosedSurface& surface);

}  // namespace sunder::aim
