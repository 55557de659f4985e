#include "weights/internal/coupled_refit.h"

#include <atomic>

namespace sunder {
namespace {

/// Set once by sunder::coupled_refit, which links Ceres; this library must not.
std::atomic<CoupledSolver> solver = nullptr;

}  // namespace

void set_coupled_solver(CoupledSolver to) { solver = to; }

bool has_coupled_refit() { return solver != nullptr; }

Result<std::vector<CoupledFit>> refit_coupled(std::span<const PointToRefit> points,
                                              std::span<const RefitNeighbours> neighbours,
                                              const CoupledRefitOptions& options,
                                              const PoseMoments& moments) {
  if (const CoupledSolver solve = solver) return solve(points, neighbours, options, moments);
  return Status::failure(StatusCode::unsupported_feature, kNone,
                         "neighbouring points cannot be fitted together: this program does not "
                         "link sunder::coupled_refit, or does not call use_coupled_refit()");
}

}  // namespace sunder
