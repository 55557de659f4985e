#pragma once

#include <array>

#include "pipeline/validation/checks/finding_list.h"
#include "pipeline/validation/checks/pose_block.h"
#include "pipeline/validation/checks/skin_points.h"

namespace sunder::validation {

/// Statistics of many lengths without keeping them: the 95th percentile is that of a histogram of
/// 64 bins per octave, so at most 1.6 % too large.
class Spread {
 public:
  void add(double length);
  /// Lengths of zero.
  void add_zeros(std::uint64_t count) { count_ += count; }
  [[nodiscard]] double mean() const;
  [[nodiscard]] double rms() const;
  [[nodiscard]] double percentile95() const;
  [[nodiscard]] double maximum() const { return maximum_; }

 private:
  static constexpr int kLowest = -60, kOctaves = 76, kPerOctave = 64;
  std::array<std::uint64_t, kOctaves* kPerOctave> bins_ = {};
  std::uint64_t count_ = 0;
  double sum_ = 0.0, square_ = 0.0, maximum_ = 0.0;
};

/// Largest distance of each row over all poses of some batches.
/// @param largest  one per row; raised.
void raise_largest(const SkinDifferences& rows, const PoseBatch& batch, std::span<double> largest);

/// How far the target strays from the source surface, per batch. Written to `report`: the figures
/// and the worst pose.
void measure_deviation(const RowReader& reader, const SkinDifferences& differences,
                       std::span<const PoseBatch> batches, const ModelPose& bind,
                       ValidationReport& report);

/// Vertices that stray from where their matched weights would put them. The interpolation error of
/// new vertices on the source's faces, which even perfect weights have, is not counted.
void check_deviation(const RowReader& reader, const SkinPoints& points,
                     const SkinDifferences& differences, std::span<const PoseBatch> batches,
                     const ValidationReport& report, double threshold, double error_threshold,
                     FindingList& findings);

}  // namespace sunder::validation
