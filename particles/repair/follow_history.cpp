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

void undo_until(Structure& structure, std::uint64_t operation) {
  TearLog& tears = structure.tears;
  while (!tears.done.empty() && !ends_with(tears.done, operation)) {
    tears.undone.push_back(std::move(tears.done.back()));
    tears.done.pop_back();
    Change& change = tears.undone.back();
    change.pending_after = pending_work(structure);
    exchange(structure, change);
    resume_work(structure, change.pending_before, true);
  }
}

void redo_until(Structure& structure, std::uint64_t operation) {
  TearLog& tears = structure.tears;
  while (!tears.undone.empty() && !ends_with(tears.done, operation)) {
    tears.done.push_back(std::move(tears.undone.back()));
    tears.undone.pop_back();
    exchange(structure, tears.done.back());
    resume_work(structure, tears.done.back().pending_after, !tears.undone.empty());
  }
}

}  // namespace

void follow_history(const TornModel& model, Structure& structure,
                    std::span<const ChangeRecord> changes) {
  TearLog& tears = structure.tears;
  const std::uint64_t newest = model.newest_operation();
  const bool is_undo = !model.is_in_stroke() && (newest == 0 || has_operation(tears.done, newest));
  if (is_undo) {
    undo_until(structure, newest);
  } else if (!model.is_in_stroke() && has_operation(tears.undone, newest)) {
    redo_until(structure, newest);
  } else {
    follow_operation(model, structure, changes);
    if (!model.is_in_stroke()) tears.done.back().operation = newest;
  }
  structure.gradients->forget(model.surface(), structure.dirty);
  structure.gradients->forget(model, structure, changes);
  tears.triangle_count = model.surface().triangle_count();
}

}  // namespace sunder::particles
