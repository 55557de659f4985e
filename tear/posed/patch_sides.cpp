// Sides of a plane: of whole nodes, and of the patches of a group. A bone gives the distances of
// what it moves a range; those of the vertices lie in the hull of the ranges of all bones, and near
// a weighted mean of them, as in PatchTree::Bound.
#include <algorithm>

#include "tear/posed/lane_bits.h"
#include "tear/posed/patch_tree.h"

namespace sunder::tear {
namespace {

using Lanes = Eigen::Array<float, 4, 1>;  ///< One per patch of a group.

/// A box in bind space, or one per lane.
template <class Number>
struct MiddleBox {
  std::array<Number, 3> middle, half;
};
/// Bounds of distances from the plane.
template <class Number>
struct Range {
  Number low, high;
};

float least(float a, float b) { return std::min(a, b); }
float greatest(float a, float b) { return std::max(a, b); }
Lanes least(const Lanes& a, const Lanes& b) { return a.min(b); }
Lanes greatest(const Lanes& a, const Lanes& b) { return a.max(b); }

template <class Number>
EIGEN_ALWAYS_INLINE Range<Number> range_of(const PlaneDistances::Row& row,
                                           const MiddleBox<Number>& box) {
  const Number at = (row.of[0] * box.middle[0] + row.of[1] * box.middle[1]) +
                    (row.of[2] * box.middle[2] + row.of[3]);
  const Number reach =
      row.size[0] * box.half[0] + row.size[1] * box.half[1] + row.size[2] * box.half[2];
  return {at - reach, at + reach};
}

template <class Number, class Bones>
Range<Number> hull_of(const Bones& bones, const MiddleBox<Number>& box,
                      const PlaneDistances& distances) {
  Range<Number> hull = range_of(distances.row(bones[0].slot), box);
  for (const auto& bone : bones.subspan(1)) {
    const Range<Number> range = range_of(distances.row(bone.slot), box);
    hull.low = least(hull.low, range.low);
    hull.high = greatest(hull.high, range.high);
  }
  return hull;
}

/// @param weight_unit  of the ranges of weights.
template <class Number, class Bones>
Range<Number> mean_of(const Bones& bones, float weight_unit, const MiddleBox<Number>& box,
                      const PlaneDistances& distances) {
  const Range<Number> main = range_of(distances.row(bones[0].slot), box);
  Range<Number> mean = main;
  for (const auto& bone : bones.subspan(1)) {
    const Range<Number> range = range_of(distances.row(bone.slot), box);
    const float from = weight_unit * static_cast<float>(bone.least_weight),
                to = weight_unit * static_cast<float>(bone.greatest_weight);
    const Number down = range.low - main.low, up = range.high - main.high;
    mean.low += least(Number(from * down), Number(to * down));
    mean.high += greatest(Number(from * up), Number(to * up));
  }
  return mean;
}

}  // namespace

/// A node, and what is needed to bound it.
struct PatchTree::ComparedNode {
  ComparedNode(const PatchTree& tree, Index node, const PlaneDistances& distances_)
      : bones(tree.bones_of(node)), distances(distances_), weight_slack(tree.weight_slack_) {
    const FloatBox& bind = tree.nodes_[node].bind;
    for (std::size_t k = 0; k < 3; ++k) {
      const float largest = std::max(std::abs(bind.low[k]), std::abs(bind.high[k]));
      box.middle[k] = 0.5f * bind.low[k] + 0.5f * bind.high[k];
      // Widened by what middles and half sizes may be rounded by.
      box.half[k] = 0.5f * (bind.high[k] - bind.low[k]) + kFloatSumCoordinates * largest;
      sizes += largest;
    }
    const bool is_displaced =
        !tree.first_morph_.empty() && tree.first_morph_[node] < tree.first_morph_[node + 1];
    is_bounded = tree.is_bounded_ && !is_displaced && sizes < kLargestPosedMetres;
  }

  [[nodiscard]] bool has_mean() const { return bones.size() <= kFewBones; }
  /// The error of bounds whose hull has a width.
  [[nodiscard]] float error_of(float width) const {
    // Vertices that operations make have up to three times as many influences as their corners.
    const float influences = 3 * (weight_slack / static_cast<float>(kWeightSumPerInfluence));
    const float terms = distances.terms_at(sizes);
    const auto count = static_cast<float>(bones.size() + 4);
    return distances.error_at(sizes).with(influences) + weight_slack * terms +
           count * kFloatTerms * (terms + count * width);
  }

  std::span<const NodeBone> bones;
  const PlaneDistances& distances;
  float weight_slack;
  MiddleBox<float> box;
  float sizes = 0;  ///< Of the largest coordinates.
  bool is_bounded;
};

std::uint8_t PatchTree::side_of(Index level, Index number, const PlaneDistances& distances) const {
  const ComparedNode node(*this, first_of_level_[level] + number, distances);
  if (!node.is_bounded) return PlaneDistances::kAcross;
  const Range<float> hull = hull_of(node.bones, node.box, distances);
  const float error = node.error_of(hull.high - hull.low);
  const auto side_of = [&](const Range<float>& range) -> std::uint8_t {
    return range.low > error     ? PlaneDistances::kInside
           : range.high < -error ? PlaneDistances::kOutside
                                 : PlaneDistances::kAcross;
  };
  const std::uint8_t side = side_of(hull);
  if (side != PlaneDistances::kAcross || !node.has_mean()) return side;
  return side_of(mean_of(node.bones, 1 / kWeightParts, node.box, distances));
}

std::uint32_t PatchTree::patches_across(Index group, const PlaneDistances& distances) const {
  const Index first = kPatchesPerGroup * group,
              count = std::min(kPatchesPerGroup, patch_count() - first);
  const ComparedNode node(*this, group, distances);
  const std::uint32_t all = (1u << count) - 1;
  if (!node.is_bounded) return all;
  MiddleBox<Lanes> boxes;
  const FloatBox& bind = nodes_[group].bind;
  for (std::size_t k = 0; k < 3; ++k) {
    Lanes low = Lanes::Zero(), high = Lanes::Zero();
    for (Index i = 0; i < count; ++i) {
      low[i] = patches_[first + i].low[k];
      high[i] = patches_[first + i].high[k];
    }
    const float half_part = (0.5f / kBoxParts) * (bind.high[k] - bind.low[k]);
    boxes.middle[k] = node.box.middle[k] + half_part * (low - high);
    boxes.half[k] = node.box.half[k] - half_part * (low + high);
  }
  const Range<Lanes> hull = hull_of(node.bones, boxes, distances);
  const Lanes error = Lanes::Constant(node.error_of((hull.high - hull.low).maxCoeff()));
  const auto across = [&](const Range<Lanes>& range) {
    return all & ~(lanes_greater(range.low, error) | lanes_greater(-range.high, error));
  };
  const std::uint32_t by_hull = across(hull);
  if (by_hull == 0 || !node.has_mean()) return by_hull;
  return by_hull & across(mean_of(node.bones, 1 / kWeightParts, boxes, distances));
}

}  // namespace sunder::tear
