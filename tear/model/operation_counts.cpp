#include "tear/internal/operation_counts.h"

#include "tear/model/model_access.h"

namespace sunder::tear {

std::vector<OperationCounts> counts_before_operations(const TornModel& model) {
  const auto& state = ModelAccess::state_of(model);
  std::vector<OperationCounts> counts;
  counts.reserve(state.history.done().size());
  for (const auto& entry : state.history.done())
    counts.push_back({entry->begin.points, state.editor.log.vertex_counts_at(entry->begin)});
  return counts;
}

}  // namespace sunder::tear
