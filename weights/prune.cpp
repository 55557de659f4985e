#include <sunder/weights/influences.h>

#include <algorithm>

#include "core/internal/ordered.h"
#include "weights/weight_sum.h"

namespace sunder {
namespace {

/// sum_i w_i M_i p, and the sum of the weights.
struct WeightedSum {
  Vec3d position = Vec3d::Zero();
  double weight = 0.0;

  WeightedSum(const Vec3d& bind_position, std::span<const Influence> influences,
              std::span<const Affine3d> model_from_bind) {
    for (const Influence& influence : influences) {
      const auto w = static_cast<double>(influence.weight);
      position += w * transform(model_from_bind[influence.slot], bind_position);
      weight += w;
    }
  }
};

}  // namespace

bool sort_influences(std::span<Influence> influences) {
  if (!(sum_of_weights(influences) > 0.0)) return false;
  std::sort(influences.begin(), influences.end(), [](const Influence& a, const Influence& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.slot < b.slot;
  });
  return true;
}

std::size_t prune_influences(std::span<Influence> influences, std::size_t maximum) {
  if (maximum == 0) return sum_of_weights(influences) > 0.0 ? influences.size() : 0;
  if (!sort_influences(influences)) return 0;
  if (influences.size() <= maximum) return influences.size();
  const auto kept = influences.first(maximum);
  const double sum = sum_of_weights(kept);
  for (Influence& influence : kept)
    influence.weight = static_cast<float>(static_cast<double>(influence.weight) / sum);
  return maximum;
}

double dropped_mass(std::span<const Influence> influences, std::size_t kept) {
  if (kept >= influences.size()) return 0.0;
  const double of_kept = sum_of_weights(influences.first(kept)),
               of_dropped = sum_of_weights(influences.subspan(kept));
  return of_dropped > 0.0 ? of_dropped / (of_kept + of_dropped) : 0.0;
}

Vec3d pruning_displacement(const Vec3d& bind_position, std::span<const Influence> influences,
                           std::size_t kept, std::span<const Affine3d> model_from_bind) {
  if (kept >= influences.size()) return Vec3d::Zero();
  const WeightedSum of_kept(bind_position, influences.first(kept), model_from_bind);
  const WeightedSum of_dropped(bind_position, influences.subspan(kept), model_from_bind);
  if (!(of_kept.weight > 0.0) || !(of_dropped.weight > 0.0)) return Vec3d::Zero();
  const double mass = of_dropped.weight / (of_kept.weight + of_dropped.weight);
  return mass * (of_kept.position / of_kept.weight - of_dropped.position / of_dropped.weight);
}

}  // namespace sunder
