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
      planes_(&editor.scratch()),
      places_(kPoints, editor.scratch()),
      bits_(&editor.scratch()) {
  planes_.reserve(cell.size());
  for (const auto& [normal, offset] : cell)
    planes_.push_back(
        {normal.x(), normal.y(), normal.z(), offset,
         2 * kOnPlaneTerms * (std::abs(normal.x()) + std::abs(normal.y()) + std::abs(normal.z())),
         2 * kOnPlaneTerms * std::abs(offset)});
  bits_.reserve(2 * words_ * kPoints);
}

Index CellSides::place_of(Index point) {
  const auto place = static_cast<Index>(bits_.size());
  const Index known = places_.insert(point, place);
  if (known != kNone) return known;
  compare(posed_.position(editor_, point));
  return place;
}

void CellSides::compare(const Vec3d& position) {
  const double x = position.x(), y = position.y(), z = position.z();
  const double reach = position.cwiseAbs().maxCoeff();
  const std::size_t begin = bits_.size(), count = cell_.size();
  bits_.resize(begin + 2 * words_);
  Word* const outside = &bits_[begin];
  Word* const inside = outside + words_;
  for (std::size_t first = 0, word = 0; first < count; first += kBits, ++word) {
    const std::size_t end = std::min<std::size_t>(count, first + kBits);
    Word is_inside = 0, is_doubtful = 0;
    for (std::size_t i = first; i < end; ++i) {
      const Plane& plane = planes_[i];
      const double value = plane.x * x + plane.y * y + plane.z * z - plane.offset;
      // At least what contains() allows for rounding.
      const double rounding = plane.steepness * reach + plane.least_rounding;
      is_inside |= Word{value > rounding} << (i - first);
      is_doubtful |= Word{!(std::abs(value) > rounding)} << (i - first);
    }
    inside[word] = is_inside;
    outside[word] = ~(is_inside | is_doubtful) & all(static_cast<Index>(word));
    for_each_bit(is_doubtful, static_cast<Index>(word), [&](Index side) {
      if (!cell_[side].contains(position)) outside[word] |= Word{1} << (side % kBits);
    });
  }
}

}  // namespace sunder::tear
