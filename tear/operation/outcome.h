#pragma once

#include <sunder/tear/report.h>

#include "tear/surface/opened_borders.h"

namespace sunder::tear {

/// The figures and borders of one call of an operation. Each step adds its own: sums are taken in
/// the order of the steps, so that they have the same bits however a stroke is divided into calls.
struct Outcome {
  TearReport report;
  OpenedBorders& borders;
};

}  // namespace sunder::tear
