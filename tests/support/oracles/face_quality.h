#pragma once

#include <sunder/tear/torn_model.h>

#include <vector>

namespace sunder::test {

/// The shape of a model's surface in bind space, without retired triangles, walls and caps.
struct FaceQuality {
  std::vector<double> smallest_angles;  ///< One per face, degrees, ascending.
  std::size_t faces_without_area = 0;

  /// `part` 0.01: the 1st percentile.
  [[nodiscard]] double angle_at(double part) const;
};

FaceQuality face_quality(const TornModel& model);

}  // namespace sunder::test
