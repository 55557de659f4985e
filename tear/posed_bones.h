#pragma once

#include <sunder/core/math.h>

#include <array>
#include <span>
#include <vector>

namespace sunder::tear {

/// The matrices that pose a skin, turned into the axes of a query when they are first asked for.
class PosedBones {
 public:
  using Lanes = Eigen::Array<double, 4, 1>;  ///< x, y, z, and one that nobody asks for.

  struct Bone {
    Lanes x, y, z, translation;             ///< Columns.
    Lanes size_of_x, size_of_y, size_of_z;  ///< Their absolute values.
    std::array<double, 3> rounding;         ///< A point may be off by each of these x its coordinate,
    double rounding_of_translation;         ///< and this.
  };

  void resize(std::size_t slot_count) {
    bones_.resize(slot_count);
    known_since_.resize(slot_count, 0);
  }
  void forget_epochs() { known_since_.assign(known_since_.size(), 0); }
  /// What the calls of at() are about from now on. @param axes  rows.
  void stand_in(std::span<const Affine3d> palette, const Mat3d& axes, std::uint32_t epoch) {
    palette_ = palette;
    for (int k = 0; k < 3; ++k) axis_[static_cast<std::size_t>(k)] << axes(0, k), axes(1, k), axes(2, k), 0.0;
    epoch_ = epoch;
  }

  [[nodiscard]] const Bone& at(std::size_t slot) {
    if (known_since_[slot] != epoch_) turn(slot);
    return bones_[slot];
  }

 private:
  void turn(std::size_t slot) {
    constexpr double kRounding = 1e-13;  // of a sum of some products in double, many times over
    Bone& bone = bones_[slot];
    const double* from = palette_[slot].data();
    const Lanes x = axis_[0], y = axis_[1], z = axis_[2];
    const auto column = [&](std::size_t j) -> Lanes { return x * from[3 * j] + y * from[3 * j + 1] + z * from[3 * j + 2]; };
    const auto rounding = [&](std::size_t j) {
      return kRounding * (std::abs(from[3 * j]) + std::abs(from[3 * j + 1]) + std::abs(from[3 * j + 2]));
    };
    bone.x = column(0);
    bone.y = column(1);
    bone.z = column(2);
    bone.translation = column(3);
    bone.size_of_x = bone.x.abs();
    bone.size_of_y = bone.y.abs();
    bone.size_of_z = bone.z.abs();
    bone.rounding = {rounding(0), rounding(1), rounding(2)};
    bone.rounding_of_translation = rounding(3);
    known_since_[slot] = epoch_;
  }
  std::span<const Affine3d> palette_;
  std::array<Lanes, 3> axis_;  ///< Each of the model's, in the query's.
  std::uint32_t epoch_ = 0;
  std::vector<Bone> bones_;
  std::vector<std::uint32_t> known_since_;
};

}  // namespace sunder::tear
