#pragma once

#include <sunder/io/character_file.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <optional>

#include "tools/blood/blood_layers.h"
#include "tools/messages/messages.h"
#include "tools/model/posed_source.h"
#include "tools/open/opening.h"
#include "tools/tear/detached_pieces.h"
#include "tools/tear/report.h"
#include "tools/tear/robot_tear.h"
#include "tools/verbs.h"
#include "tools/written_weights/certified_weights.h"
#include "tools/written_weights/written_influences.h"

namespace sunder::tools {

/// The options for weights of new points, from the command line.
struct Weighing {
  WeightOptions options;
  std::optional<RefitOptions> refit;  ///< For `refit`, if the model bends.
};

/// Sums over the operations of a run, for its summary.
struct RunTotals {
  std::size_t done = 0, missed = 0, pieces = 0;
  std::size_t refused = 0;  ///< With --keep-going.
  std::uint64_t faces_crossed = 0, blocked = 0;
};

/// Durations in seconds.
struct RunTimes {
  double loading = 0, operations = 0, saving = 0;
};

/// What --blood adds to the model.
struct RunBlood {
  double reach = 0;                            ///< Metres.
  std::vector<std::vector<std::byte>> images;  ///< PNG, per texture of `layers`, which has none.
  BloodLayers layers;
};

/// The pictures that --wound-mask writes.
struct RunWounds {
  Picture mask;
  std::vector<ChannelPicture> channels;
};

/// A model to which operations are applied, and their reports.
struct TearRun {
  const TearRequest& request;
  const Messages& messages;
  Budget& budget;
  const LoadedCharacter& loaded;
  TornModel model;
  Weighing weighing;
  PosedSource posed_source;
  TopologyCounts source = {}, result = {};
  Json reports = Json::array();
  std::optional<CertifiedWeights> certified = {};  ///< With --max-error.
  PruningLoss pruning = {};                        ///< Without it.
  RunTotals totals = {};
  RunTimes times = {};
  bool has_findings = false, has_picture = false;
  std::optional<RobotTear> robot = {};        ///< With --robot.
  std::optional<DetachedPieces> pieces = {};  ///< With --pieces.
  std::vector<std::string> piece_files = {};  ///< Those that were written.
  std::vector<Operation> played = {};         ///< Those that met the surface, as given.
  AuthoredTissue tissue = {};                 ///< Of --tissue-field.
  std::optional<Opening> opening = {};        ///< With --open.
  std::optional<RunBlood> blood = {};         ///< With --blood.
  std::optional<RunWounds> wounds = {};       ///< With --wound-mask, if a mesh has room for it.
};

}  // namespace sunder::tools
