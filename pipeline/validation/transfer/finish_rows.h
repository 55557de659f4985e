#pragma once

#include <sunder/validation/transfer.h>

#include <vector>

#include "pipeline/validation/internal/weight_row.h"

namespace sunder::validation {

/// Weights of points before they are made valid.
struct UnfinishedRows {
  std::vector<WeightRow> rows;
  std::vector<WeightRow> fallback;  ///< Where nothing is left of a row: those of the closest place.
  std::vector<WeightRow> own;       ///< That the target had.
  std::vector<int> side;            ///< -1 left, +1 right, 0 neither.
  std::vector<bool> is_filled;      ///< Not as matched: continued or smoothed.
  std::vector<bool> is_locked;      ///< Not touched.
};

struct FinishRules {
  std::vector<int> side_of_bone;
  std::vector<bool> is_chosen;  ///< Per bone: whether its weights are replaced.
  double mix = 1;
  std::uint32_t maximum_influences = 0;
};

struct FinishedRows {
  std::vector<WeightRow> rows;  ///< >= 0, sum 1.
  std::vector<TransferStep> steps;
};

/// Removes negative weights, weights of the other side and, of filled points, weights below 1e-4;
/// puts back what is not to be replaced, and limits the influences. Rows are normalised after each
/// step, and the change that each makes is measured.
[[nodiscard]] FinishedRows finish_rows(UnfinishedRows unfinished, const FinishRules& rules);

}  // namespace sunder::validation
