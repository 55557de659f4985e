#pragma once

#include <sunder/tear/wound_mask.h>

#include "tools/render/png_file.h"
#include "tools/tear/tear_run.h"

namespace sunder::tools {

/// Masks of one model in one picture. Red: nearness to a lip, 255 at a lip, 0 from the reach on.
/// Green: how much of the texel was removed. Blue: 255 where a mesh uses the texel. Where masks
/// share a texel, the one that is nearer to a lip counts.
/// @param masks  of one size; at least one.
[[nodiscard]] Picture wound_picture(std::span<const WoundMask> masks);

/// With `--wound-mask`, draws what it writes, and says what it cannot show. A model without texture
/// coordinates is a finding.
/// @return ok, or the exit code of the failure, which was reported.
[[nodiscard]] ExitCode draw_wounds_of_run(TearRun& run);

/// Writes what was drawn.
/// @return ok, or the exit code of the failure, which was reported.
[[nodiscard]] ExitCode write_wounds_of_run(const TearRun& run);

/// The files and the values of their levels, for the report; if something was drawn.
[[nodiscard]] Json wounds_json(const TearRun& run);

}  // namespace sunder::tools
