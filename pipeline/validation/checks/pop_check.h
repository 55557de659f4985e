#pragma once

#include <sunder/tear/torn_model.h>

#include <memory>
#include <optional>

#include "pipeline/validation/checks/finding_list.h"

namespace sunder::validation {

/// Plays a log on the source and reports, per operation, how far it moves the posed surface at its
/// moment. Each new vertex is compared, in the pose of the operation, with its place on the surface
/// just before: the triangle there that contains the place where it was made, posed and
/// interpolated. A tear whose pose changes is compared blade by blade, each in its own pose.
/// Operations that assign weights are compared vertex by vertex. Walls and caps, and what is made
/// on them later, are new surface and not compared; the surface that a gap or bore removes is not
/// either. Undo and redo repeat what was compared before.
/// @param target    the place of a finding names a vertex where this has it.
/// @param diagonal  of the source in the rest pose, metres.
/// @return the torn model; none if an operation fails, which is a finding.
[[nodiscard]] std::optional<TornModel> check_pops(const std::shared_ptr<const Character>& source,
                                                  const Character& target,
                                                  std::span<const Operation> operations,
                                                  double diagonal, FindingList& findings);

}  // namespace sunder::validation
