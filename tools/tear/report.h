#pragma once

#include <sunder/operation/operation.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <optional>
#include <string>

#include "tools/messages/json.h"
#include "tools/tear/detached_pieces.h"

namespace sunder::tools {

/// The topology before and after an operation.
struct TopologyChange {
  TopologyCounts before, after;
};

/// The results of one operation.
struct OperationOutcome {
  const char* op = "";    ///< Its name in a log.
  const char* done = "";  ///< Its status in the report, if it did not miss.
  bool has_missed = false;
  TearReport tear;
  double seconds = 0;                         ///< Duration of the operation alone.
  std::vector<PieceDescription> pieces = {};  ///< Of TearReport::pieces.
  std::size_t threads = 0;                    ///< Of a suture.
  /// Greatest distance of a new point from the untorn surface, in the poses of the operation;
  /// metres. Only if it was measured.
  std::optional<double> weight_error_max = {};
  std::optional<TopologyChange> topology = {};  ///< Only if it was counted.
};

/// Performs an operation and describes its results.
/// @param pieces  optional; keeps what a detachment takes off.
[[nodiscard]] Result<OperationOutcome> play(const Operation& operation, TornModel& model,
                                            DetachedPieces* detached = nullptr);

/// Measures OperationOutcome::weight_error_max. O(vertices of the source + new points).
/// @param outcome  of the newest operation.
[[nodiscard]] Status measure_weight_error(const Operation& operation, const TornModel& model,
                                          OperationOutcome& outcome);

/// @param character  after the operation; pieces refer to its meshes and bones.
[[nodiscard]] Json to_json(const OperationOutcome& outcome, const Character& character);

/// The result of all operations, with the topology of the source for comparison.
[[nodiscard]] Json result_json(const TornModel& torn, const TopologyCounts& source,
                               const TopologyCounts& result);

}  // namespace sunder::tools
