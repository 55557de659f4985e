#pragma once

#include <sunder/core/skeleton.h>

#include <cstdint>
#include <span>
#include <vector>

namespace sunder::ragdoll {

/// Which bones have a body, and which bodies they hang on.
struct BodyTree {
  std::vector<std::uint32_t> bones;         ///< Per body: the bone that moves its part.
  std::vector<std::uint32_t> joint_bones;   ///< Per body: the topmost bone that moves with it.
  std::vector<std::uint32_t> parents;       ///< Per body; kNone at a root. Smaller numbers.
  std::vector<std::uint32_t> body_of_bone;  ///< Per bone, those without a body of their own too.
};

/// Gives a body to each bone with a mass, and ties it to that of the bone above. A bone without a
/// mass moves with the heaviest body just below it, or else with that above. A body with a smaller
/// share of the mass than `least_share` joins the one above, and so do the lightest ones of more
/// than `most`; one without any above it joins the heaviest below it.
/// @param masses  per bone, >= 0, at least one above 0. Deterministic. @throws std::bad_alloc
[[nodiscard]] BodyTree make_body_tree(const Skeleton& skeleton, std::vector<double> masses,
                                      std::uint32_t most, double least_share);

/// Ties bodies to others with whose parts theirs have a border, if they have none with that above:
/// the feet of a rig whose feet do not hang on its legs.
/// @param borders  per pair of bodies, row by row: the places that their parts share.
void follow_borders(std::span<const std::uint32_t> borders, BodyTree& tree);

}  // namespace sunder::ragdoll
