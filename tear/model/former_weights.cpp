#include "tear/internal/former_weights.h"

#include "tear/model/model_access.h"

namespace sunder::tear {

std::vector<FormerWeights> weights_before_newest_operation(const TornModel& model) {
  const auto& done = ModelAccess::state_of(model).history.done();
  std::vector<FormerWeights> former;
  if (done.empty() || !std::holds_alternative<WeightsOperation>(done.back()->operation))
    return former;
  const WeightChange& change = done.back()->weights;
  const std::span<const Influence> influences = change.influences;
  former.reserve(change.vertices.size());
  for (const VertexWeights& of : change.vertices)
    former.push_back({of.mesh, of.vertex, of.position,
                      influences.subspan(of.first_influence, of.influence_count),
                      of.policy == WeightPolicy::exact});
  return former;
}

}  // namespace sunder::tear
