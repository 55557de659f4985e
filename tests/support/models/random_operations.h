#pragma once

#include <sunder/tear/torn_model.h>

#include "support/machine/random.h"

namespace sunder::test {

/// A random sheet or tube.
Character random_character(Random& random);

/// A random tear with or without width, cut or bore somewhere on the surface of a model's source,
/// in a random pose given by matrices.
Operation random_operation(const TornModel& model, Random& random);

/// A tear along a random stroke in a random pose; with or without width.
TearOperation random_tear(const TornModel& model, Random& random, bool has_width);

/// Tears and cuts that remove nothing, so that welds can close them.
/// @param has_fillings  whether they may have walls and caps.
Operation random_lossless_operation(const TornModel& model, Random& random, bool has_fillings);

/// A weld of all wounds, or of the one near a place of the surface, to its ends or a part of it.
WeldOperation random_weld(const TornModel& model, Random& random);
/// Threads for the wounds that random_weld() would close.
SutureOperation random_suture(const TornModel& model, Random& random);

/// Blades that go down through the sheet of make_sheet(), along a path that turns at random and
/// stays on the sheet.
Stroke turning_stroke(Random& random);

/// Performs an operation of the functions above.
Result<TearReport> play(TornModel& model, const Operation& operation,
                        ChangeRecord* change = nullptr);

}  // namespace sunder::test
