#include "tools/model/coupled_refits.h"

#include <algorithm>
#include <variant>

#include "tools/model/ceres_program.h"
#include "weights/internal/coupled_refit.h"

namespace sunder::tools {
namespace {

bool asks_for_coupled_refit(const LoggedOperation& logged) {
  const auto* const operation = std::get_if<Operation>(&logged);
  const auto* const weights =
      operation == nullptr ? nullptr : std::get_if<WeightsOperation>(operation);
  return weights != nullptr && weights->weights.policy == WeightPolicy::refit &&
         weights->refit.is_coupled;
}

}  // namespace

Status provide_coupled_refits(std::span<const LoggedOperation> log) {
  if (has_coupled_refit() || std::none_of(log.begin(), log.end(), asks_for_coupled_refit))
    return {};
  return become_ceres_program("neighbours are fitted together (\"coupled\")");
}

}  // namespace sunder::tools
