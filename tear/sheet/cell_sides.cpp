#include "tear/sheet/cell_sides.h"

#include <algorithm>
#include <cmath>

#include "tear/geometry/tolerances.h"

namespace sunder::tear {
namespace {

/// Number of points for which there is room at first.
constexpr std::size_t kPoints = 256;

}  // namespace

CellSides::CellSides(std::span<const PlaneSide> cell, const SurfaceEditor& editor,
                     PosedPoints& posed)
    : cell_(cell),
      editor_(editor),
      posed_(posed),
      words_(std::max(Index{1}, (static_cast<Index>(cell.size()) + kBits - 1) / kBits)),
      steepness_(&editor.scratch()),
      places_(kPoints, editor.scratch()),
      bits_(&editor.scratch()) {
  steepness_.reserve(cell.size());
  for (const PlaneSide& side : cell)
    steepness_.push_back(std::abs(side.normal.x()) + std::abs(side.normal.y()) +
                         std::abs(side.normal.z()));
  bits_.reserve(2 * words_ * kPoints);
}

CellSides::OfFace CellSides::of_points(const std::array<Index, 3>& points) {
  const std::array<Index, 3> places = {place_of(points[0]), place_of(points[1]),
                                       place_of(points[2])};
  OfFace of{};
  for (std::size_t k = 0; k < 3; ++k) {
    of.outside[k] = &bits_[places[k]];
    of.inside[k] = of.outside[k] + words_;
  }
  return of;
}

Index CellSides::place_of(Index point) {
  const auto place = static_cast<Index>(bits_.size());
  const Index known = places_.insert(point, place);
  if (known != kNone) return known;
  compare(posed_.position(editor_, point));
  return place;
}

void CellSides::compare(const Vec3d& position) {
  const double reach = position.cwiseAbs().maxCoeff();
  const std::size_t begin = bits_.size();
  bits_.resize(begin + 2 * words_);
  Word* const outside = &bits_[begin];
  Word* const inside = outside + words_;
  for (std::size_t first = 0, word = 0; first < cell_.size(); first += kBits, ++word) {
    const std::size_t end = std::min<std::size_t>(cell_.size(), first + kBits);
    Word bit = 1;
    for (std::size_t i = first; i < end; ++i, bit <<= 1) {
      const PlaneSide& side = cell_[i];
      const double value = side.value(position);
      // At least what contains() allows for rounding.
      const double rounding =
          2 * kOnPlaneTerms * (steepness_[i] * reach + std::abs(side.offset));
      if (value > rounding)
        inside[word] |= bit;
      else if (value < -rounding || !side.contains(position))
        outside[word] |= bit;
    }
  }
}

}  // namespace sunder::tear
