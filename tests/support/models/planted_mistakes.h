#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/operation.h>
#include <sunder/weights/influences.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace sunder::test {

/// Mistakes that tools make with skins.
enum class Mistake {
  end_point_copied,
  t_swapped,
  first_four_kept,
  sums_of_98_percent,
  bytes_rounded_one_by_one,
  byte_sums_off_by_one,
  bones_swapped,
  bone_unmapped,
  weights_moved_to_first_bone,
  lip_welded,
  t_junction,
  morph_lost,
  bind_stale,
  default_pose_moved,
  far_bone_bleeds,
  left_follows_right,
  scaled_by_100,
  uv_of_one_end,
  normals_flipped,
};
inline constexpr int kMistakes = 19;

/// A source and the target that a tool with one mistake would make of it.
struct PlantedMistake {
  std::string code;  ///< Under which it has to be found.
  Character source, target;
  std::vector<StoredInfluences> stored_source, stored_target;
  /// Mesh and vertex of the target: all that the mistake touched, and those of them where it is
  /// large enough that it must be found. Empty: the mistake is about bones.
  std::set<std::pair<Index, Index>> touched, must;
  std::set<Index> bones;  ///< Of the target.
};

/// Makes a model ready (tears it, gives it a morph target, more influences or a mirrored half,
/// where the mistake needs that) and makes the mistake in the copy.
PlantedMistake plant(Mistake mistake, const Character& model);

/// How a file would store the influences of a character.
std::vector<StoredInfluences> stored_as(const Character& character, WeightFormat format);

}  // namespace sunder::test
