#pragma once

#include <vector>

#include "tools/blood/blood_layers.h"
#include "tools/tear/tear_run.h"

namespace sunder::tools {

/// With --blood, lays blood around the wounds on copies of the textures. Says what has no room in a
/// texture. Warns, as a finding, if there is no wound.
/// @return ok, or the exit code of the failure, which was reported.
[[nodiscard]] ExitCode lay_blood_of_run(TearRun& run);

/// SaveOptions::painted; nothing without --blood.
[[nodiscard]] std::vector<PaintedMaterial> painted_materials(const TearRun& run);

/// Gives the painted materials, and the colours of vertices, to a character that begins with the
/// vertices of the torn model.
/// @param first_material  the number of the first painted one.
void give_blood(const TearRun& run, std::uint32_t first_material, Character& character);
/// Gives them to a piece that came off.
/// @return the piece as it was without --blood.
[[nodiscard]] std::shared_ptr<const Character> with_blood(
    const TearRun& run, std::uint32_t first_material, const DetachedPiece& piece,
    std::shared_ptr<const Character> character);

/// The object `blood` of the report; only with --blood.
[[nodiscard]] Json blood_json(const TearRun& run);

}  // namespace sunder::tools
