#pragma once

#include <array>
#include <vector>

#include "pipeline/aim/bone_tree.h"
#include "pipeline/aim/posed_surface.h"

namespace sunder::aim {

/// The role of a bone for a limb.
enum class BoneRole : std::uint8_t {
  own,     ///< The bone that the limb is named after, see BoneTree::same_bones().
  below,   ///< The others of the limb, see bones_of_limb().
  parent,  ///< The nearest bone above that moves something.
  above,   ///< Above that one.
  other,
};

/// Weights of a place on the surface, summed by role.
struct LimbShares {
  std::array<double, 5> of_role = {};

  [[nodiscard]] double own() const { return of_role[0]; }
  [[nodiscard]] double below() const { return of_role[1]; }
  [[nodiscard]] double limb() const { return of_role[0] + of_role[1]; }
  [[nodiscard]] double parent() const { return of_role[2]; }
  /// The share of all bones that are neither of the limb nor its parent.
  [[nodiscard]] double other() const { return of_role[3] + of_role[4]; }
  /// The share of those among them that are not above the limb: of other limbs.
  [[nodiscard]] double other_limbs() const { return of_role[4]; }
  void add(const LimbShares& shares, double factor) {
    for (std::size_t i = 0; i < of_role.size(); ++i) of_role[i] += factor * shares.of_role[i];
  }
};

/// The roles of all bones for one limb.
class LimbBones {
 public:
  LimbBones(const PosedSurface& surface, const BoneTree& tree, Index bone);

  [[nodiscard]] Index bone() const { return bone_; }
  /// The nearest bone above that moves something; kNone if there is none.
  [[nodiscard]] Index parent() const { return parent_; }
  /// Adds what a bone moves to the sums of all other limbs that hold it: its own, and those of the
  /// bones on which it hangs. A bone above the limb counts alone.
  void add_to_others(std::vector<double>& sums, Index bone, double amount) const {
    if (roles_[bone] == BoneRole::own || roles_[bone] == BoneRole::below) return;
    for (; bone != kNone; bone = other_above_[bone]) sums[bone] += amount;
  }
  [[nodiscard]] LimbShares shares(Index point) const;
  /// Mean of the corners.
  [[nodiscard]] LimbShares shares_of_face(Index face) const;

 private:
  const PosedSurface& surface_;
  Index bone_, parent_;
  std::vector<BoneRole> roles_;  ///< Per bone of the skeleton.
  /// Per bone of another limb, the one of it on which it hangs; kNone if there is none.
  std::vector<Index> other_above_;
};

}  // namespace sunder::aim
