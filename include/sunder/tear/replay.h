#pragma once

#include <sunder/tear/torn_model.h>

namespace sunder {

/// Does what an operation says: poses are looked up in the model's skeleton and clips.
/// @return as the operation's own call; not_found for a clip or bone that the character does not have, and for undo and redo of
/// more
///         than there is (nothing is taken back then).
SUNDER_API Result<TearReport> apply_operation(TornModel& model, const Operation& operation, ChangeRecord* change = nullptr);

}  // namespace sunder
