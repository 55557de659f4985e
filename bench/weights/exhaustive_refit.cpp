#include "bench/weights/exhaustive_refit.h"

#include <algorithm>
#include <bit>
#include <limits>

#include <Eigen/Dense>

namespace sunder::bench {
namespace {

constexpr int kTurns = 500;
constexpr double kLeastGain = 1e-9;  // of a turn

}  // namespace

ExhaustiveRefit::ExhaustiveRefit(const AnimationPoint& exact, const Vec3d& position,
                                 std::span<const std::vector<Affine3d>> palettes)
    : position_(position) {
  for (const AnimationPoint::Term& term : exact.terms()) slots_.push_back(term.slot);
  const std::size_t n = slots_.size();
  moments_.assign(n * n, Matrix::Zero());
  std::vector<Eigen::Matrix<double, 3, 4>> off(n);
  double weight = 0;
  for (const AnimationPoint::Term& term : exact.terms()) weight += term.q.w();
  for (const std::vector<Affine3d>& palette : palettes) {
    const Eigen::Vector3d belongs = exact.posed(palette) / weight;
    for (std::size_t i = 0; i < n; ++i) {
      const Affine3d& bone = palette[slots_[i]];
      off[i].leftCols<3>() = bone.linear();
      off[i].col(3) = bone.linear() * position_ + Eigen::Vector3d(bone.translation()) - belongs;
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        moments_[i * n + j] += off[i].transpose() * off[j] / static_cast<double>(palettes.size());
  }
}

double ExhaustiveRefit::mean_square(std::span<const Influence> influences,
                                    const Vec3d& position) const {
  Eigen::Vector4d at;
  at << position - position_, 1;
  double sum = 0, weights = 0;
  for (const Influence& a : influences) {
    const auto i =
        static_cast<std::size_t>(std::find(slots_.begin(), slots_.end(), a.slot) - slots_.begin());
    weights += static_cast<double>(a.weight);
    for (const Influence& b : influences) {
      const auto j = static_cast<std::size_t>(std::find(slots_.begin(), slots_.end(), b.slot) -
                                              slots_.begin());
      sum +=
          static_cast<double>(a.weight) * static_cast<double>(b.weight) * at.dot(moment(i, j) * at);
    }
  }
  return std::max(sum, 0.0) / (weights * weights);
}

/// The minimum of w^T G w with sum 1 lies inside one of the faces of the simplex, where G w is the
/// same for all bones of the face.
double ExhaustiveRefit::solve_weights(const Support& support, const Eigen::Vector3d& offset,
                                      double* weights) const {
  const Eigen::Vector4d at(offset.x(), offset.y(), offset.z(), 1);
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 8, 8>;
  using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1>;
  const auto n = static_cast<Eigen::Index>(support.count);
  Small gram(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      gram(i, j) = at.dot(moment(support.bones[static_cast<std::size_t>(i)],
                                 support.bones[static_cast<std::size_t>(j)]) *
                          at);
  gram.diagonal().array() += 1e-14 * gram.trace() + 1e-280;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned face = 1; face < (1u << support.count); ++face) {
    Eigen::Index of[8];
    Eigen::Index count = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      if ((face >> i & 1u) != 0) of[count++] = i;
    Small inside(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j) inside(i, j) = gram(of[i], of[j]);
    SmallVector solution = inside.ldlt().solve(SmallVector::Ones(count));
    solution /= solution.sum();
    if (!(solution.minCoeff() >= 0)) continue;
    const double value = solution.dot(inside * solution);
    if (!(value < least)) continue;
    least = value;
    std::fill(weights, weights + support.count, 0.0);
    for (Eigen::Index i = 0; i < count; ++i) weights[of[i]] = solution[i];
  }
  return least;
}

double ExhaustiveRefit::solve_offset(const Support& support, const double* weights,
                                     Eigen::Vector3d& offset) const {
  Eigen::Matrix4d square = Eigen::Matrix4d::Zero();
  for (std::size_t i = 0; i < support.count; ++i)
    for (std::size_t j = 0; j < support.count; ++j)
      if (weights[i] > 0 && weights[j] > 0)
        square += weights[i] * weights[j] * moment(support.bones[i], support.bones[j]);
  Eigen::Matrix3d left = square.topLeftCorner<3, 3>();
  left.diagonal().array() += 1e-13 * left.trace() + 1e-280;
  const Eigen::Vector3d best = -left.ldlt().solve(square.topRightCorner<3, 1>());
  if (best.allFinite()) offset = best;
  const Eigen::Vector4d at(offset.x(), offset.y(), offset.z(), 1);
  return at.dot(square * at);
}

double ExhaustiveRefit::take_turns(const Support& support, Eigen::Vector3d offset) const {
  double weights[8];
  double least = solve_weights(support, offset, weights);
  for (int turn = 0; turn < kTurns; ++turn) {
    const double with_offset = solve_offset(support, weights, offset);
    const double value = std::min(with_offset, solve_weights(support, offset, weights));
    if (!(value < (1 - kLeastGain) * least)) return std::max(std::min(least, value), 0.0);
    least = value;
  }
  return std::max(least, 0.0);
}

double ExhaustiveRefit::least_mean_square(std::size_t maximum, const Vec3d& start) const {
  double least = std::numeric_limits<double>::infinity();
  const std::size_t wanted = std::min(maximum, slots_.size());
  for (unsigned bits = 1; bits < (1u << slots_.size()); ++bits) {
    if (static_cast<std::size_t>(std::popcount(bits)) != wanted) continue;
    Support support;
    for (std::size_t i = 0; i < slots_.size(); ++i)
      if ((bits >> i & 1u) != 0) support.bones[support.count++] = i;
    std::vector<Eigen::Vector3d> starts = {Eigen::Vector3d::Zero(),
                                           Eigen::Vector3d(start) - position_};
    // Start positions: one per bone, with most of the weight on that bone, and one with equal
    // weights.
    for (std::size_t heavy = 0; heavy <= support.count; ++heavy) {
      double weights[8];
      for (std::size_t i = 0; i < support.count; ++i)
        weights[i] = (heavy == support.count ? 1.0
                      : i == heavy           ? 0.8
                                             : 0.2) /
                     static_cast<double>(support.count);
      Eigen::Vector3d offset = Eigen::Vector3d::Zero();
      (void)solve_offset(support, weights, offset);
      starts.push_back(offset);
    }
    for (const Eigen::Vector3d& offset : starts)
      least = std::min(least, take_turns(support, offset));
  }
  return least;
}

}  // namespace sunder::bench
