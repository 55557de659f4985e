#pragma once

#include <sunder/core/skeleton.h>
#include <sunder/core/status.h>
#include <sunder/validation/transfer.h>

#include <span>
#include <string>
#include <vector>

namespace sunder::validation {

/// How the counterpart of a bone was found.
enum class BoneMatchKind : std::uint8_t {
  none,     ///< It has no counterpart.
  mapping,  ///< The caller named the pair.
  exact,    ///< Same name.
  fuzzy,    ///< Names that differ in case, separators, prefix or in how they say left and right.
};

/// The bones of a target and their counterparts in a source.
struct BoneMatch {
  std::vector<Index> source_of_target;  ///< Per bone of the target; kNone: no counterpart.
  std::vector<BoneMatchKind> kind;      ///< Per bone of the target.
  /// Per bone of the target: the bone of the source that moves it. Its counterpart, else that of
  /// its nearest ancestor that has one, else bone 0.
  std::vector<Index> driver_of_target;
  std::vector<Index> target_of_source;  ///< Per bone of the source; kNone: no counterpart.

  [[nodiscard]] Index count(BoneMatchKind of_kind) const;
};

/// Matches the bones of two skeletons: first the pairs given, then equal names, then fuzzy names
/// that are unambiguous on both sides.
/// @param mapping  may give several bones of the target the same one of the source.
/// @return not_found for a pair that names no bone; invalid_argument if a bone of the target is
/// named twice; the index is that of the pair. O(bones log bones), allocates.
[[nodiscard]] Result<BoneMatch> match_bones(const Skeleton& source, const Skeleton& target,
                                            std::span<const BoneNames> mapping = {});

}  // namespace sunder::validation
