#pragma once

#include <sunder/io/character_file.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include "tools/report.h"

namespace sunder::tools {

/// What a file loses of the influences of the torn meshes.
struct PruningLoss {
  std::uint64_t vertices_pruned = 0;
  double dropped_mass_max = 0;
  /// How far pruning moves a vertex, at most, in the rest pose and in those of the model's history;
  /// metres, in closed form.
  double pruning_error_max = 0;
};

/// @param maximum  as SaveOptions. O(influences of the torn meshes x poses).
/// @return what compute_model_pose(), make_pose() and compute_palette() find.
[[nodiscard]] Result<PruningLoss> measure_pruning(const TornModel& model, std::uint32_t maximum);

/// "float", "u16" or "u8", as --weights-as takes it.
[[nodiscard]] const char* weight_format_name(WeightFormat format);

/// What is written of the influences, and what that loses.
[[nodiscard]] Json to_json(const PruningLoss& loss, const SaveOptions& options);

}  // namespace sunder::tools
