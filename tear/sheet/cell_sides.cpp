#include "tear/sheet/cell_sides.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"

namespace sunder::tear {
namespace {

/// Number of points for which there is room at first.
constexpr std::size_t kPoints = 256;

}  // namespace

CellSides::CellSides(std::span<const PlaneSide> cell, const SurfaceEditor& editor,
                     PosedPoints& posed, const Core& core)
    : cell_(cell),
      editor_(editor),
      posed_(posed),
      core_(core),
      words_(std::max(Index{1}, (static_cast<Index>(cell.size()) + kBits - 1) / kBits)),
      planes_((cell.size() + kLanes - 1) / kLanes, &editor.scratch()),
      places_(kPoints, editor.scratch()),
      positions_(&editor.scratch()),
      bits_(&editor.scratch()) {
  for (Index i = 0; i < cell.size(); ++i) {
    const auto& [normal, offset] = cell[i];
    Planes& planes = planes_[i / kLanes];
    const Index lane = i % kLanes;
    planes.x[lane] = normal.x();
    planes.y[lane] = normal.y();
    planes.z[lane] = normal.z();
    planes.offset[lane] = offset;
    planes.steepness[lane] =
        2 * kOnPlaneTerms * (std::abs(normal.x()) + std::abs(normal.y()) + std::abs(normal.z()));
    planes.rounding[lane] = 2 * kOnPlaneTerms * std::abs(offset);
  }
  positions_.reserve(kPoints);
  bits_.reserve(2 * words_ * kPoints);
}

Index CellSides::place_of(Index point) {
  const auto place = static_cast<Index>(positions_.size());
  const Index known = places_.insert(point, place);
  if (known != kNone) return known;
  compare(positions_.emplace_back(posed_.position(editor_, point)));
  return place;
}

bool CellSides::is_in_core(const Vec3d& position, double reach) const {
  const double radius =
      core_.radius - kPosedCoordinates * (reach + core_.origin.cwiseAbs().maxCoeff());
  return radius > 0 && squared_norm((position - core_.origin).cross(core_.axis)) < radius * radius;
}

void CellSides::compare(const Vec3d& position) {
  const double x = position.x(), y = position.y(), z = position.z();
  const double reach = position.cwiseAbs().maxCoeff();
  const std::size_t begin = bits_.size();
  bits_.resize(begin + 2 * words_);
  Word* const outside = &bits_[begin];
  Word* const inside = outside + words_;
  const Index known = is_in_core(position, reach) ? core_.sides : 0;
  for (Index i = 0; i < known / kBits; ++i) inside[i] = ~Word{0};
  if (known % kBits != 0) inside[known / kBits] = (Word{1} << known % kBits) - 1;
  const auto count = static_cast<Index>(cell_.size());
  for (Index first = known / kLanes * kLanes; first < count; first += kLanes) {
    const Planes& planes = planes_[first / kLanes];
    std::array<double, kLanes> value, rounding;  // at least what contains() allows for rounding
    for (Index i = 0; i < kLanes; ++i) {
      value[i] = planes.x[i] * x + planes.y[i] * y + planes.z[i] * z - planes.offset[i];
      rounding[i] = planes.steepness[i] * reach + planes.rounding[i];
    }
    Word is_inside = 0, is_outside = 0;
    for (Index i = 0; i < kLanes; ++i) {
      is_inside |= Word{value[i] > rounding[i]} << i;
      is_outside |= Word{value[i] < -rounding[i]} << i;
    }
    inside[first / kBits] |= is_inside << first % kBits;
    outside[first / kBits] |= is_outside << first % kBits;
    const Word exist = (Word{1} << std::min(kLanes, count - first)) - 1;
    for_each_bit(~(is_inside | is_outside) & exist, 0, [&](Index side) {
      if (!cell_[first + side].contains(position))
        outside[first / kBits] |= Word{1} << (first + side) % kBits;
    });
  }
}

}  // namespace sunder::tear
