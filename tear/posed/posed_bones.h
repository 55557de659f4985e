#pragma once

#include <array>
#include <span>
#include <vector>

#include "tear/geometry/box.h"
#include "tear/geometry/tolerances.h"

namespace sunder::tear {

/// The matrices of a posed skin in the frame of a query, each computed on demand.
class PosedBones {
  /// x, y, z, and an unused one.
 public:
  using Lanes = Eigen::Array<float, 4, 1>;

  struct Bone {
    Lanes x, y, z, translation;             ///< Columns.
    Lanes size_of_x, size_of_y, size_of_z;  ///< Upper bounds of the absolute values of the columns.
    Lanes rounding;  ///< Rounding error of a posed point that does not depend on its bind position.
  };
  /// Rounding of a bone with a larger matrix, which bounds nothing.
  static constexpr float kEverywhere = 1e37f;

  void resize(std::size_t slot_count) {
    bones_.resize(slot_count);
    known_since_.resize(slot_count, 0);
  }
  void forget_epochs() { known_since_.assign(known_since_.size(), 0); }
  /// Sets the palette, frame and epoch of the following calls of at().
  void stand_in(std::span<const Affine3d> palette, const Frame& frame, std::uint32_t epoch) {
    palette_ = palette;
    frame_ = frame;
    reach_ = frame.reach();
    for (int k = 0; k < 3; ++k)
      axis_[static_cast<std::size_t>(k)] << frame.axes(0, k), frame.axes(1, k), frame.axes(2, k),
          0.0;
    epoch_ = epoch;
  }
  [[nodiscard]] const Frame& frame() const { return frame_; }

  [[nodiscard]] const Bone& at(std::size_t slot) {
    if (known_since_[slot] != epoch_) turn(slot);
    return bones_[slot];
  }

 private:
  using Doubles = Eigen::Array<double, 4, 1>;

  void turn(std::size_t slot) {
    Bone& bone = bones_[slot];
    const double* from = palette_[slot].data();
    const auto turned = [&](double x, double y, double z) -> Doubles {
      return axis_[0] * x + axis_[1] * y + axis_[2] * z;
    };
    const Doubles x = turned(from[0], from[1], from[2]), y = turned(from[3], from[4], from[5]),
                  z = turned(from[6], from[7], from[8]);
    const Doubles translation = turned(from[9] - frame_.origin.x(), from[10] - frame_.origin.y(),
                                       from[11] - frame_.origin.z());
    known_since_[slot] = epoch_;
    const double in_model =
        std::max({std::abs(from[9]), std::abs(from[10]), std::abs(from[11])}) + reach_;
    const Doubles largest = x.abs().max(y.abs()).max(z.abs()).max(translation.abs());
    if (!(largest.maxCoeff() < kLargestPosedMetres && in_model < kFarthestPosedMetres)) {
      bone = {Lanes::Zero(), Lanes::Zero(), Lanes::Zero(), Lanes::Zero(),
              Lanes::Zero(), Lanes::Zero(), Lanes::Zero(), Lanes::Constant(kEverywhere)};
      return;
    }
    bone.x = x.cast<float>();
    bone.y = y.cast<float>();
    bone.z = z.cast<float>();
    bone.translation = translation.cast<float>();
    // The rounding of doubles may leave an arbitrary rest in a component that cancelled.
    const auto size_of = [](const Lanes& column) -> Lanes {
      return column.abs() + kCancelledTerms * column.abs().sum();
    };
    bone.size_of_x = size_of(bone.x);
    bone.size_of_y = size_of(bone.y);
    bone.size_of_z = size_of(bone.z);
    bone.rounding = kFloatCoordinates * bone.translation.abs() +
                    (static_cast<float>(kTranslationCoordinates * in_model) + kLeastRoundingMetres);
  }

  std::span<const Affine3d> palette_;
  Frame frame_;
  double reach_ = 0;
  std::array<Doubles, 3> axis_;  ///< Each axis of the model, in the frame.
  std::uint32_t epoch_ = 0;
  std::vector<Bone> bones_;
  std::vector<std::uint32_t> known_since_;
};

}  // namespace sunder::tear
