#pragma once

#include <sunder/operation/aimed_operation.h>
#include <sunder/tear/torn_model.h>

#include <cstdint>
#include <string_view>

namespace sunder {

/// Turns an operation that names bones into a plain one, in the same pose. It is aimed at the model
/// as it is torn so far, so a later operation is resolved after the earlier ones were applied.
/// docs/aim.md describes the method and its limits.
///
/// @return a TearOperation, CutOperation or DrillOperation; not_found for an unknown bone, clip or
///         mesh, for a bone that moves nothing, and where the limb has no surface of its own;
///         invalid_argument for a length, share or direction outside its range;
///         index_out_of_range for a triangle; the failures of make_pose(); limit_exceeded: out of
///         memory. O(size of the model), allocates. Reentrant.
[[nodiscard]] SUNDER_API Result<Operation> resolve(const TornModel& model,
                                                   const AimedOperation& operation);

/// The bone with a name or, if there is none, the only one with that name behind a namespace or
/// prefix that ends with ':' or '|'.
/// @return not_found, with the names most like it; invalid_argument if several bones have the name
///         behind a prefix.
[[nodiscard]] SUNDER_API Result<std::uint32_t> find_bone(const Skeleton& skeleton,
                                                         std::string_view name);

}  // namespace sunder
