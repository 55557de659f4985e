#include "weights/internal/coupled_refit.h"

namespace sunder {

bool has_coupled_refit() { return false; }

Result<std::vector<CoupledFit>> refit_coupled(std::span<const PointToRefit>,
                                              std::span<const RefitNeighbours>,
                                              const CoupledRefitOptions&, const PoseMoments&) {
  return Status::failure(StatusCode::unsupported_feature, kNone,
                         "this build cannot fit neighbouring points together: it was configured "
                         "without Ceres (SUNDER_CERES)");
}

}  // namespace sunder
