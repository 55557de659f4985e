#pragma once

#include "bench/weights/lip_quality.h"
#include "bench/weights/weights_figures.h"

namespace sunder::bench {

/// The results of run_other_solvers() for the problems of all models, concatenated.
void print_weights_tables(const std::vector<ModelFigures>& models, const RigFigures& rigs,
                          const std::vector<LipQuality>& lips,
                          const std::vector<SolverFigures>& solvers);
void print_weights_summary(const Summary& summary, std::FILE* file);
/// Every model, policy and K; in per cent of the diagonal and in metres. @return false if it cannot
/// be written.
[[nodiscard]] bool write_weights_json(const std::vector<ModelFigures>& models,
                                      const RigFigures& rigs, const char* file);

}  // namespace sunder::bench
