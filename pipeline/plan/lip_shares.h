#pragma once

#include <sunder/plan/plan.h>
#include <sunder/tear/torn_model.h>

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// The share of a curve's length that is nearest to each point of the lips of changes, in a pose.
[[nodiscard]] Result<std::unordered_map<std::uint32_t, double>> lip_shares(
    const TornModel& model, std::span<const ChangeRecord> changes, const TargetPath& path,
    const ModelPose& pose);

/// Tension::shares: nodes of a profile along the curve at points of lips; 1 elsewhere.
[[nodiscard]] std::vector<float> shares_of_points(
    const std::unordered_map<std::uint32_t, double>& lips, std::span<const double> nodes);

}  // namespace sunder::plan
