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

/// Blades that go down through the sheet of make_sheet(), along a path that turns at random and
/// stays on the sheet.
Stroke turning_stroke(Random& random);

/// Performs an operation of random_operation() or random_tear().
Result<TearReport> play(TornModel& model, const Operation& operation,
                        ChangeRecord* change = nullptr);

}  // namespace sunder::test
