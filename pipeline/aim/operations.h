#pragma once

#include <sunder/aim/aim.h>

#include "pipeline/aim/posed_surface.h"
#include "pipeline/aim/trial_cut.h"

namespace sunder::aim {

// Each function resolves one operation on the surface in the operation's pose.
[[nodiscard]] Result<Operation> resolve_slash(const PosedSurface& surface,
                                              const SlashOperation& slash);
[[nodiscard]] Result<Operation> resolve_sever(const PosedSurface& surface,
                                              const SeverOperation& sever);
/// Why a sever does not take off what a judge asks for; ok if it does.
[[nodiscard]] Status severs(const PosedSurface& surface, const SeverOperation& sever,
                            const SeverJudge& judge);
/// Finds what a sever will take off.
[[nodiscard]] Result<SeveredPieces> find_severed_pieces(const PosedSurface& surface,
                                                        const SeverOperation& sever);
[[nodiscard]] Result<Operation> resolve_puncture(const PosedSurface& surface,
                                                 const PunctureOperation& puncture);
[[nodiscard]] Result<Operation> resolve_incision(const PosedSurface& surface,
                                                 const IncisionOperation& incision);

/// The share of the limb's width by which blades and bores begin before its surface, and end behind
/// it; where another surface is nearer than twice that, half of the way to it.
inline constexpr double kClearanceWidths = 0.25;

}  // namespace sunder::aim
