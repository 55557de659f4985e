#include "particles/repair/follow_history.h"

#include <algorithm>

#include "particles/clusters/band.h"
#include "particles/clusters/gradients.h"
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

/// Exchanges changes of one stack and moves them to the other, until the changes that are done end
/// with an operation.
void exchange_until(Structure& structure, std::uint64_t operation, std::vector<Change>& from,
                    std::vector<Change>& to) {
  while (!from.empty() && !ends_with(structure.tears.done, operation)) {
    exchange(structure, from.back());
    to.push_back(std::move(from.back()));
    from.pop_back();
  }
}

}  // namespace

void follow_history(const TornModel& model, Structure& structure,
                    std::span<const ChangeRecord> changes) {
  TearLog& tears = structure.tears;
  const std::uint64_t newest = model.newest_operation();
  const bool is_undo = !model.is_in_stroke() && (newest == 0 || has_operation(tears.done, newest));
  // A tear that is undone, with the points that it created, need not be completed.
  if (is_undo && !ends_with(tears.done, newest)) tears.band.reset();
  const bool is_in_stroke = !tears.done.empty() && tears.done.back().operation == 0;
  if (tears.band && !is_in_stroke) complete_band(model, structure);
  if (is_undo) {
    exchange_until(structure, newest, tears.done, tears.undone);
  } else if (!model.is_in_stroke() && has_operation(tears.undone, newest)) {
    exchange_until(structure, newest, tears.undone, tears.done);
  } else {
    follow_operation(model, structure, changes);
    if (!model.is_in_stroke()) tears.done.back().operation = newest;
  }
  structure.gradients->forget(model.surface(), structure.dirty);
  structure.gradients->forget(model, structure, changes);
  tears.triangle_count = model.surface().triangle_count();
}

}  // namespace sunder::particles
