#pragma once

#include <sunder/tear/torn_model.h>

#include <vector>

namespace sunder {

/// Does what an operation says: poses are looked up in the model's skeleton and clips.
/// @param changes  appended where given: one record for each step, in order. Undo and redo of several operations, and a stroke in
///                 several poses, are several steps.
/// @return as the operation's own call; not_found for a clip or bone that the character does not have, and for undo and redo of
/// more
///         than there is (nothing is taken back then).
SUNDER_API Result<TearReport> apply_operation(TornModel& model, const Operation& operation,
                                              std::vector<ChangeRecord>* changes = nullptr);

}  // namespace sunder
