#include "tear/posed/plane_distances.h"

namespace sunder::tear {

PlaneDistances::PlaneDistances(const PlaneSide& plane, std::span<const Affine3d> palette,
                               double on_plane, ScratchMemory& memory)
    : rows_(palette.size(), &memory) {
  const Vec3d size = plane.normal.cwiseAbs();
  double steepest = 0, farthest = 0, in_model = std::abs(plane.offset);
  for (std::size_t slot = 0; slot < palette.size(); ++slot) {
    const double* const columns = palette[slot].data();
    std::array<double, 4> row, size_of;
    for (std::size_t column = 0; column < 4; ++column) {
      const double* const at = columns + 3 * column;
      row[column] = plane.normal.x() * at[0] + plane.normal.y() * at[1] + plane.normal.z() * at[2];
      size_of[column] =
          size.x() * std::abs(at[0]) + size.y() * std::abs(at[1]) + size.z() * std::abs(at[2]);
    }
    row[3] -= plane.offset;
    steepest = std::max({steepest, size_of[0], size_of[1], size_of[2]});
    farthest = std::max(farthest, std::abs(row[3]));
    in_model = std::max(in_model, size_of[3] + std::abs(plane.offset));
    for (std::size_t column = 0; column < 4; ++column) {
      rows_[slot].of[column] = static_cast<float>(row[column]);
      rows_[slot].size[column] = std::abs(rows_[slot].of[column]);
    }
  }
  const auto is_in_float = [](double value) { return value < double{kLargestPosedMetres}; };
  if (!is_in_float(steepest) || !is_in_float(farthest) || !(in_model < kFarthestPosedMetres)) {
    rounding_ = std::numeric_limits<float>::infinity();
    return;
  }
  // Numbers below the least normal one lose digits.
  steepest_ = std::max(static_cast<float>(steepest), std::numeric_limits<float>::min());
  farthest_ = static_cast<float>(farthest);
  slack_ = static_cast<float>(2 * kWeightSumPerInfluence * std::abs(plane.offset));
  rounding_ = static_cast<float>(kPosedCoordinates * in_model + on_plane) + kLeastRoundingMetres;
}

}  // namespace sunder::tear
