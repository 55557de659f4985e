#pragma once

#include <sunder/tear/report.h>

#include <optional>

#include "tear/surface/edit_log.h"
#include "tear/surface/opened_borders.h"

namespace sunder::tear {

/// The figures and borders of one call of an operation. Each step adds its own: sums are taken in
/// the order of the steps, so that they have the same bits however a stroke is divided into calls.
struct Outcome {
  TearReport report;
  OpenedBorders& borders;
  /// The changes before walls were added, if these were the last step of the call.
  std::optional<EditLog::Extent> before_walls = {};
};

}  // namespace sunder::tear
