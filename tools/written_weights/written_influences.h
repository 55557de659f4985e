#pragma once

#include <sunder/io/character_file.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <string>

#include "tools/messages/json.h"

namespace sunder::tools {

/// The effect of pruning on the written meshes.
struct PruningLoss {
  std::uint32_t most = 0;  ///< Influences of the vertex with the most, as written.
  std::uint64_t vertices_pruned = 0;
  double dropped_mass_max = 0;
  /// Greatest displacement of a vertex by pruning, at rest, in the poses of the history and in
  /// those of the clips that a refit would use; metres, in closed form.
  double pruning_error_max = 0;
};

/// Measures what saving a torn model with these options drops. O(pruned influences x poses).
/// @return the failures of written_influences(), compute_model_pose(), make_pose() and
/// compute_palette().
[[nodiscard]] Result<PruningLoss> measure_pruning(const TornModel& model,
                                                  const LoadedCharacter& loaded,
                                                  const SaveOptions& options);

/// SaveOptions::maximum_influences as --influences takes it: "source", "4", "8" or "all".
[[nodiscard]] std::string influences_name(std::uint32_t maximum);

/// Whether --influences gives a number.
[[nodiscard]] inline bool limits_influences(const SaveOptions& save) {
  return save.maximum_influences != 0 && save.maximum_influences != kAllInfluences;
}

/// "float", "u16" or "u8", as --weights-as takes it.
[[nodiscard]] const char* weight_format_name(WeightFormat format);

/// How influences are written, and the resulting errors.
[[nodiscard]] Json to_json(const PruningLoss& loss, const SaveOptions& options);

}  // namespace sunder::tools
