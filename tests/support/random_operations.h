#pragma once

#include <sunder/tear/torn_model.h>

#include "support/random.h"

namespace sunder::test {

/// A sheet or a tube, of any fineness.
Character random_character(Random& random);

/// A tear with or without width, a cut or a bore, somewhere on the surface of a model's source, in
/// a random pose that is given in full.
Operation random_operation(const TornModel& model, Random& random);

/// A tear along a random stroke in a random pose; with or without width.
TearOperation random_tear(const TornModel& model, Random& random, bool has_width);

/// Blades that go down through the sheet of make_sheet(), along a way that turns at random and
/// stays on it.
Stroke turning_stroke(Random& random);

/// Calls what an operation of random_operation() or random_tear() stands for.
Result<TearReport> play(TornModel& model, const Operation& operation,
                        ChangeRecord* change = nullptr);

}  // namespace sunder::test
