#pragma once

#include <sunder/aim/aim.h>

#include "aim/posed_surface.h"

namespace sunder::aim {

/// Of what the limb moves on its body, most must come off: of what lies beyond the plane, or of
/// all.
enum class SeverJudge : std::uint8_t { beyond_plane, whole_limb };

// Each function resolves one operation on the surface in the operation's pose.
[[nodiscard]] Result<Operation> resolve_slash(const PosedSurface& surface,
                                              const SlashOperation& slash);
/// @param judge  how much of the limb must come off.
[[nodiscard]] Result<Operation> resolve_sever(const PosedSurface& surface,
                                              const SeverOperation& sever,
                                              SeverJudge judge = SeverJudge::beyond_plane);
/// What comes off at a sever, before it is applied.
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
