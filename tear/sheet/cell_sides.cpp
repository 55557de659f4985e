#include "tear/sheet/cell_sides.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/posed/lane_bits.h"

namespace sunder::tear {
namespace {

/// Number of points for which there is room at first.
constexpr std::size_t kPoints = 256;
/// Coordinates and coefficients of planes beyond these are compared in double alone.
constexpr double kLargestInLanes = 1e15, kLargestOffsetInLanes = 1e30;

double sum_of_sizes(const Vec3d& v) { return std::abs(v.x()) + std::abs(v.y()) + std::abs(v.z()); }

/// Whether a half-space contains a point, whatever rounding does.
bool surely_contains(const PlaneSide& side, const Vec3d& point) {
  const double reach = point.cwiseAbs().maxCoeff();
  return side.value(point) >
         2 * kOnPlaneTerms * (sum_of_sizes(side.normal) * reach + std::abs(side.offset));
}

}  // namespace

CellSides::CellSides(std::span<const PlaneSide> cell, const SurfaceEditor& editor,
                     PosedPoints& posed, const Core& core)
    : cell_(cell),
      editor_(editor),
      posed_(posed),
      core_(core),
      words_(std::max(Index{1}, (static_cast<Index>(cell.size()) + kBits - 1) / kBits)),
      planes_(&editor.scratch()),
      places_(kPoints, editor.scratch()),
      positions_(&editor.scratch()),
      bits_(&editor.scratch()) {
  positions_.reserve(kPoints);
  bits_.reserve(2 * words_ * kPoints);
}

void CellSides::begin_at(const Vec3d& origin) {
  origin_ = origin;
  const Lanes zero = Lanes::Zero();
  planes_.assign((cell_.size() + kLanes - 1) / kLanes, {zero, zero, zero, zero, zero, zero});
  const double reach = origin.cwiseAbs().maxCoeff();
  for (Index i = 0; i < cell_.size(); ++i) {
    const auto& [normal, from_zero] = cell_[i];
    const double steepness = sum_of_sizes(normal);
    const double offset = from_zero - dot(normal, origin);
    // Twice what contains() allows at the origin, and what floats need.
    const double rounding = 4 * kOnPlaneTerms * (steepness * reach + std::abs(from_zero)) +
                            kInFloatTerms * std::abs(offset);
    Planes& planes = planes_[i / kLanes];
    const Index lane = i % kLanes;
    if (steepness < kLargestInLanes && rounding < kLargestOffsetInLanes &&
        std::abs(offset) < kLargestOffsetInLanes) {
      planes.x[lane] = static_cast<float>(normal.x());
      planes.y[lane] = static_cast<float>(normal.y());
      planes.z[lane] = static_cast<float>(normal.z());
      planes.offset[lane] = static_cast<float>(offset);
      planes.steepness[lane] = static_cast<float>(kInFloatTerms * steepness);
      planes.rounding[lane] =
          static_cast<float>(rounding) + std::numeric_limits<float>::min();  // of underflow
    } else {
      planes.rounding[lane] = std::numeric_limits<float>::max();
    }
  }
}

Index CellSides::place_of(Index point) {
  const auto place = static_cast<Index>(positions_.size());
  const Index known = places_.insert(point, place);
  if (known != kNone) return known;
  const Vec3d& position = positions_.emplace_back(posed_.position(editor_, point));
  if (place == 0) begin_at(position);
  compare(position);
  return place;
}

bool CellSides::is_in_core(const Vec3d& position) const {
  if (core_.sides == 0) return false;
  const double radius = core_.radius - kPosedCoordinates * (position.cwiseAbs().maxCoeff() +
                                                            core_.origin.cwiseAbs().maxCoeff());
  return radius > 0 && squared_norm((position - core_.origin).cross(core_.axis)) < radius * radius;
}

void CellSides::compare(const Vec3d& position) {
  const std::size_t begin = bits_.size();
  bits_.resize(begin + 2 * words_);
  Word* const outside = &bits_[begin];
  Word* const inside = outside + words_;
  const Vec3d from_origin = position - origin_;
  const double reach = from_origin.cwiseAbs().maxCoeff();
  if (!(reach < kLargestInLanes)) {
    for (Index w = 0; w < words_; ++w) compare(position, all(w), w, outside[w], inside[w]);
    return;
  }
  const Index known = is_in_core(position) ? core_.sides : 0;
  for (Index i = 0; i < known / kBits; ++i) inside[i] = ~Word{0};
  if (known % kBits != 0) inside[known / kBits] = (Word{1} << known % kBits) - 1;
  const auto x = static_cast<float>(from_origin.x()), y = static_cast<float>(from_origin.y()),
             z = static_cast<float>(from_origin.z()), largest = static_cast<float>(reach);
  const auto count = static_cast<Index>(cell_.size());
  for (Index first = known / kLanes * kLanes; first < count; first += kLanes) {
    const Planes& planes = planes_[first / kLanes];
    const Lanes value = planes.x * x + planes.y * y + planes.z * z - planes.offset;
    const Lanes rounding = planes.steepness * largest + planes.rounding;
    inside[first / kBits] |= Word{lanes_greater(value, rounding)} << first % kBits;
    outside[first / kBits] |= Word{lanes_greater(-value, rounding)} << first % kBits;
  }
  for (Index w = 0; w < words_; ++w) {
    outside[w] &= all(w);
    inside[w] &= all(w);
    compare(position, ~(outside[w] | inside[w]) & all(w), w, outside[w], inside[w]);
  }
}

void CellSides::compare(const Vec3d& position, Word sides, Index word, Word& outside,
                        Word& inside) const {
  for_each_bit(sides, word, [&](Index number) {
    const Word bit = Word{1} << number % kBits;
    if (!cell_[number].contains(position))
      outside |= bit;
    else if (surely_contains(cell_[number], position))
      inside |= bit;
  });
}

}  // namespace sunder::tear
