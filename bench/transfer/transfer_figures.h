#pragma once

#include <sunder/validation/transfer.h>

#include <string>
#include <vector>

namespace sunder::bench {

/// A target whose weights are known.
struct TransferCase {
  std::string name;
  Character truth;
};

/// The source itself, subdivided, offset by 0.5, 1, 2 and 4 % of its diagonal, decimated, torn.
std::vector<TransferCase> transfer_cases(const Character& source);

/// How far transferred weights are from the known ones.
struct TransferFigures {
  double l1 = 0;       ///< Sum over bones of |difference|, mean over the vertices.
  double rms = 0;      ///< Of posed positions over 20 random poses; share of the diagonal.
  double matched = 0;  ///< Share of the vertices.
  double seconds = 0;
};

/// Transfers to the truth, of which all vertices were attached to one bone before.
TransferFigures measure_transfer(const Character& source, const Character& truth,
                                 const TransferOptions& options);

}  // namespace sunder::bench
