#include "particles/repair/follow_history.h"

#include <algorithm>

#include "particles/clusters/band.h"
#include "particles/clusters/gradients.h"
#include "particles/repair/lip_band.h"
#include "particles/repair/repair.h"

namespace sunder::particles {
namespace {

bool has_operation(std::span<const Change> changes, std::uint64_t operation) {
  return std::ranges::any_of(changes,
                             [&](const Change& change) { return change.operation == operation; });
}

/// Whether the changes that are done end with an operation; for 0, whether there are none.
bool ends_with(std::span<const Change> done, std::uint64_t operation) {
  if (operation == 0 || done.empty()) return operation == 0 && done.empty();
  return done.back().operation == operation;
}

/// Names an operation that was followed before the set was saved and restored: its model has
/// another number for it now.
void name_restored(const TornModel& model, TearLog& tears) {
  const std::uint32_t count = model.undo_count();
  if (model.is_in_stroke() || count == 0 || count > tears.done.size()) return;
  Change& change = tears.done[count - 1];
  if (change.operation == Change::kUnnamed) change.operation = model.newest_operation();
}

/// Undoes changes until those that are done end with an operation.
/// @return whether the gradients of all changes were logged.
bool undo_until(Structure& structure, std::uint64_t operation) {
  TearLog& tears = structure.tears;
  bool all_known = true;
  while (!tears.done.empty() && !ends_with(tears.done, operation)) {
    tears.undone.push_back(std::move(tears.done.back()));
    tears.done.pop_back();
    Change& change = tears.undone.back();
    change.pending_after = pending_work(structure);
    exchange(structure, change);
    all_known &= structure.gradients->exchange(change);
    resume_work(structure, change.pending_before, true);
  }
  return all_known;
}

/// The same for redo.
bool redo_until(Structure& structure, std::uint64_t operation) {
  TearLog& tears = structure.tears;
  bool all_known = true;
  while (!tears.undone.empty() && !ends_with(tears.done, operation)) {
    tears.done.push_back(std::move(tears.undone.back()));
    tears.undone.pop_back();
    exchange(structure, tears.done.back());
    all_known &= structure.gradients->exchange(tears.done.back());
    resume_work(structure, tears.done.back().pending_after, !tears.undone.empty());
  }
  return all_known;
}

}  // namespace

void follow_history(const TornModel& model, Structure& structure,
                    std::span<const ChangeRecord> changes) {
  TearLog& tears = structure.tears;
  name_restored(model, tears);
  const std::uint64_t newest = model.newest_operation();
  const bool is_undo = !model.is_in_stroke() && (newest == 0 || has_operation(tears.done, newest));
  bool has_gradients = false;
  Change* followed = nullptr;
  if (is_undo) {
    has_gradients = undo_until(structure, newest);
  } else if (!model.is_in_stroke() && has_operation(tears.undone, newest)) {
    has_gradients = redo_until(structure, newest);
  } else {
    follow_operation(model, structure, changes);
    followed = &tears.done.back();
    if (!model.is_in_stroke()) tears.done.back().operation = newest;
  }
  if (!has_gradients) {
    structure.gradients->forget(model.surface(), structure.dirty, followed);
    structure.gradients->forget(model, structure, changes, followed);
  }
  tears.triangle_count = model.surface().triangle_count();
}

}  // namespace sunder::particles
