#include <sunder/coupled_refit/use.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <exception>
#include <map>
#include <memory>

#include <Eigen/Core>
#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <ceres/sphere_manifold.h>
#include <ceres/types.h>

#include "weights/internal/coupled_refit.h"
#include "weights/internal/refit_terms.h"

namespace sunder {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int kMostSteps = 50;
/// The solver stops when a step reduces the cost by less than this fraction.
constexpr double kLeastGain = 1e-6;
/// A smaller sum of squared metres counts as zero.
constexpr double kLeastSum = 1e-200;
/// A pivot below this fraction of the largest is rounding.
constexpr double kLeastPivot = 1e-15;
/// Places between the fit of a point alone and the common one, as shares of the way.
constexpr double kShares[] = {1.0, 0.75, 0.5, 0.25, 0.125};

/// The unknowns of a point: the square roots u of its weights, w_i = u_i^2 with |u| = 1, and the
/// offset of its bind position.
struct Unknowns {
  double* roots = nullptr;
  double* offset = nullptr;  ///< nullptr: the bind position is fixed.
  int count = 0;             ///< Number of weights; 0: the point is not fitted here.
  std::vector<std::uint32_t> slots;

  [[nodiscard]] std::uint32_t slot(int i) const { return slots[static_cast<std::size_t>(i)]; }
  [[nodiscard]] int find(std::uint32_t slot) const {
    const auto place = std::find(slots.begin(), slots.end(), slot);
    return place == slots.end() ? -1 : static_cast<int>(place - slots.begin());
  }
};

/// The error of a point over all poses: root * [u_1^2 [offset; 1]; u_2^2 [offset; 1]; ...], whose
/// length is the root mean square.
class PointCost final : public ceres::CostFunction {
 public:
  PointCost(RowMajor root, const Unknowns& unknowns)
      : root_(std::move(root)), count_(unknowns.count) {
    set_num_residuals(static_cast<int>(root_.rows()));
    mutable_parameter_block_sizes()->push_back(count_);
    if (unknowns.offset != nullptr) mutable_parameter_block_sizes()->push_back(3);
  }

  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override {
    const bool moves = parameter_block_sizes().size() > 1;
    const double* const u = unknowns[0];
    const Eigen::Vector3d offset =
        moves ? Eigen::Vector3d(unknowns[1][0], unknowns[1][1], unknowns[1][2])
              : Eigen::Vector3d::Zero();
    double* const by_root = jacobians != nullptr ? jacobians[0] : nullptr;
    double* const by_offset = jacobians != nullptr && moves ? jacobians[1] : nullptr;
    for (int row = 0; row < root_.rows(); ++row) {
      const double* of_bone = root_.data() + row * root_.cols();
      double sum = 0;
      Eigen::Vector3d linear = Eigen::Vector3d::Zero();
      for (int i = 0; i < count_; ++i, of_bone += 4) {
        const Eigen::Map<const Eigen::Vector3d> linear_of_bone(of_bone);
        const double carried = linear_of_bone.dot(offset) + of_bone[3];
        sum += u[i] * u[i] * carried;
        linear += u[i] * u[i] * linear_of_bone;
        if (by_root != nullptr) by_root[row * count_ + i] = 2 * u[i] * carried;
      }
      residuals[row] = sum;
      if (by_offset != nullptr) Eigen::Map<Eigen::Vector3d>(by_offset + 3 * row) = linear;
    }
    return true;
  }

 private:
  RowMajor root_;
  int count_;
};

/// The difference between the changes of two weights: u_a^2 - u_b^2 + constant. -1: the point does
/// not have the slot.
struct ChangeOfSlot {
  int a = -1, b = -1;
  double constant = 0;
};

/// The cost of two neighbours for moving and changing differently. An untorn neighbour b has no
/// unknowns.
class NeighbourCost final : public ceres::CostFunction {
 public:
  NeighbourCost(const Unknowns& a, const Unknowns& b, std::vector<ChangeOfSlot> changes,
                double of_offset, double of_change)
      : changes_(std::move(changes)),
        counts_{a.count, b.count},
        of_offset_(of_offset),
        of_change_(of_change) {
    moves_ = a.offset != nullptr;
    set_num_residuals((moves_ ? 3 : 0) + static_cast<int>(changes_.size()));
    for (const Unknowns* unknowns : {&a, &b}) {
      if (unknowns->count == 0) continue;
      mutable_parameter_block_sizes()->push_back(unknowns->count);
      if (moves_) mutable_parameter_block_sizes()->push_back(3);
    }
  }

  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override {
    const int stride = moves_ ? 2 : 1, first = moves_ ? 3 : 0;
    for (int side = 0; side < 2; ++side) {
      if (counts_[side] == 0) continue;
      const double sign = side == 0 ? 1.0 : -1.0;
      const double* const u = unknowns[side * stride];
      double* const by_root = jacobians != nullptr ? jacobians[side * stride] : nullptr;
      double* const by_offset =
          jacobians != nullptr && moves_ ? jacobians[side * stride + 1] : nullptr;
      if (by_root != nullptr) std::fill_n(by_root, num_residuals() * counts_[side], 0.0);
      if (by_offset != nullptr) std::fill_n(by_offset, num_residuals() * 3, 0.0);
      for (int axis = 0; axis < first; ++axis) {
        residuals[axis] = (side == 0 ? 0.0 : residuals[axis]) +
                          sign * of_offset_ * unknowns[side * stride + 1][axis];
        if (by_offset != nullptr) by_offset[4 * axis] = sign * of_offset_;
      }
      for (std::size_t k = 0; k < changes_.size(); ++k) {
        const int row = first + static_cast<int>(k);
        const int i = side == 0 ? changes_[k].a : changes_[k].b;
        if (side == 0) residuals[row] = of_change_ * changes_[k].constant;
        if (i < 0) continue;
        residuals[row] += sign * of_change_ * u[i] * u[i];
        if (by_root != nullptr) by_root[row * counts_[side] + i] = 2 * sign * of_change_ * u[i];
      }
    }
    return true;
  }

 private:
  std::vector<ChangeOfSlot> changes_;
  int counts_[2];
  double of_offset_, of_change_;
  bool moves_ = false;
};

/// Objects that a problem refers to and does not own.
struct Parts {
  std::map<int, std::unique_ptr<ceres::Manifold>> spheres;  ///< By dimension.
  std::deque<PointCost> point_costs;
  std::deque<NeighbourCost> neighbour_costs;
};

/// The least squares problem over all points.
class CoupledProblem {
 public:
  CoupledProblem(std::span<const PointToRefit> points, const CoupledRefitOptions& options,
                 const PoseMoments& moments);

  void couple(std::span<const RefitNeighbours> neighbours);
  /// @return false if there is nothing to solve, or no solution.
  [[nodiscard]] bool solve();
  void take_solution();
  [[nodiscard]] std::vector<CoupledFit> take_fits() { return std::move(fits_); }

 private:
  void add_point(std::size_t point);
  void add_neighbours(std::size_t a, std::uint32_t b, double of_offset, double of_change);
  [[nodiscard]] Eigen::MatrixXd gram_of(std::size_t point) const;
  void add_restraint(std::size_t point, Eigen::MatrixXd& gram);
  [[nodiscard]] bool find_root(std::size_t point, RowMajor& root);
  [[nodiscard]] double weight_before(std::size_t point, std::uint32_t slot) const;
  [[nodiscard]] bool take_share(std::size_t point, double share, const Eigen::Vector3d& way);
  [[nodiscard]] ceres::Manifold* sphere(int size);

  std::span<const PointToRefit> points_;
  const CoupledRefitOptions& options_;
  const PoseMoments& moments_;
  std::vector<CoupledFit> fits_;
  std::vector<double> values_;
  std::vector<Unknowns> unknowns_;
  std::vector<AnimationPoint::Term> terms_, difference_;
  std::vector<double> excess_;
  std::vector<double> of_terms_, alone_, together_;
  /// Scale of the residuals. It makes the sum of squares one with barycentric weights, so that
  /// tolerances have a meaning.
  double scale_ = 1;
  bool has_unknowns_ = false;

  Parts parts_;  ///< Declared before the problem, which refers to them.
  std::unique_ptr<ceres::Problem> problem_;
};

ceres::Problem::Options problem_options() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

CoupledProblem::CoupledProblem(std::span<const PointToRefit> points,
                               const CoupledRefitOptions& options, const PoseMoments& moments)
    : points_(points),
      options_(options),
      moments_(moments),
      unknowns_(points.size()),
      problem_(std::make_unique<ceres::Problem>(problem_options())) {
  PointRefit refit;
  std::size_t value_count = 0;
  double sum = 0;
  for (const PointToRefit& point : points) {
    const PointRefit::Fit fit = refit.fit(point, options.point, moments);
    fits_.push_back({{fit.influences.begin(), fit.influences.end()},
                     fit.position,
                     fit.mean_square,
                     fit.barycentric_mean_square,
                     fit.is_better});
    value_count += fit.influences.size() + 3;
    if (std::isfinite(fit.barycentric_mean_square)) sum += fit.barycentric_mean_square;
  }
  if (!(sum > kLeastSum)) return;  // nothing to gain: all points keep their fits
  scale_ = 1 / std::sqrt(sum);
  values_.reserve(value_count);
  for (std::size_t point = 0; point < points.size(); ++point) add_point(point);
}

ceres::Manifold* CoupledProblem::sphere(int size) {
  std::unique_ptr<ceres::Manifold>& manifold = parts_.spheres[size];
  if (manifold == nullptr) manifold = std::make_unique<ceres::SphereManifold<ceres::DYNAMIC>>(size);
  return manifold.get();
}

double CoupledProblem::weight_before(std::size_t point, std::uint32_t slot) const {
  double sum = 0, weight = 0;
  for (const Influence& influence : points_[point].barycentric) {
    sum += static_cast<double>(influence.weight);
    if (influence.slot == slot) weight = static_cast<double>(influence.weight);
  }
  return weight / sum;
}

/// The mean over the poses of A_i^T A_j for the bones i, j of the fit, where A_i = [linear part of
/// M_i, M_i s - p] for the point's initial position s and the position p that it should follow.
/// Relative to s and p, because only differences from them matter.
Eigen::MatrixXd CoupledProblem::gram_of(std::size_t point) const {
  using Vec4 = Eigen::Vector4d;
  const double per_pose = 1.0 / static_cast<double>(moments_.pose_count(options_.point.group));
  const auto moment = [&](std::uint32_t i, std::uint32_t j) -> Eigen::Matrix4d {
    if (i <= j) return per_pose * moments_.of(i, j, options_.point.group);
    return per_pose * moments_.of(j, i, options_.point.group).transpose();
  };
  Eigen::Matrix4d about_place = Eigen::Matrix4d::Identity();
  about_place.topRightCorner<3, 1>() = points_[point].position - moments_.centre();

  const Unknowns& unknowns = unknowns_[point];
  const int n = unknowns.count;
  std::vector<Vec4, Eigen::aligned_allocator<Vec4>> towards_of(static_cast<std::size_t>(n),
                                                               Vec4::Zero());
  double target_square = 0;
  for (const auto& term : terms_) {
    Vec4 towards = Vec4::Zero();
    for (const auto& other : terms_)
      towards.noalias() += moment(term.slot, other.slot) * Vec4(other.q);
    target_square += Vec4(term.q).dot(towards);
    if (const int i = unknowns.find(term.slot); i >= 0)
      towards_of[static_cast<std::size_t>(i)].noalias() = about_place.transpose() * towards;
  }
  Eigen::MatrixXd gram(4 * n, 4 * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      Eigen::Matrix4d product =
          about_place.transpose() * moment(unknowns.slot(i), unknowns.slot(j)) * about_place;
      product.row(3) -= towards_of[static_cast<std::size_t>(j)].transpose();
      product.col(3) -= towards_of[static_cast<std::size_t>(i)];
      product(3, 3) += target_square;
      if (unknowns.offset == nullptr) {
        product.topRows<3>().setZero();
        product.leftCols<3>().setZero();
      }
      gram.block<4, 4>(4 * i, 4 * j) = product;
      if (i != j) gram.block<4, 4>(4 * j, 4 * i) = product.transpose();
    }
  return gram;
}

/// Adds the regularisation of a point to its form. The weights sum to one, so the offset is its own
/// mean over the bones, and terms that are linear in the weights or constant are quadratic too:
/// the regularisation can be charged bone by bone.
void CoupledProblem::add_restraint(std::size_t point, Eigen::MatrixXd& gram) {
  const Unknowns& unknowns = unknowns_[point];
  const weights::Restraint restraint = weights::restraint_of(
      terms_, points_[point].position - moments_.centre(), moments_, options_.point.group);
  weights::weights_of_terms(terms_, points_[point].barycentric, of_terms_);
  const auto before = [&](int i) {
    for (std::size_t k = 0; k < terms_.size(); ++k)
      if (terms_[k].slot == unknowns.slot(i)) return of_terms_[k];
    return 0.0;
  };
  double square_before = 0;
  for (const double weight : of_terms_) square_before += weight * weight;
  for (int i = 0; i < unknowns.count; ++i)
    for (int j = 0; j < unknowns.count; ++j) {
      for (int axis = 0; axis < 3; ++axis)
        gram(4 * i + axis, 4 * j + axis) += restraint.of_position;
      gram(4 * i + 3, 4 * j + 3) +=
          restraint.of_weights * ((i == j ? 1.0 : 0.0) - before(i) - before(j) + square_before);
    }
}

/// Cholesky factorisation with full pivoting of a positive semi-definite form: root^T root. Stops
/// at the first pivot that is only rounding.
RowMajor factor(Eigen::MatrixXd gram) {
  RowMajor root(gram.rows(), gram.cols());
  const double least = kLeastPivot * gram.diagonal().maxCoeff();
  Eigen::Index rank = 0, pivot = 0;
  while (rank < root.rows() && gram.diagonal().maxCoeff(&pivot) > least) {
    root.row(rank) = gram.row(pivot) / std::sqrt(gram(pivot, pivot));
    gram.noalias() -= root.row(rank).transpose() * root.row(rank);
    ++rank;
  }
  return root.topRows(rank);
}

/// The factor of a point's form, see gram_of() and PointCost.
/// @return false if it is not finite, or zero.
bool CoupledProblem::find_root(std::size_t point, RowMajor& root) {
  weights::centre_terms(*points_[point].exact, moments_, terms_);
  Eigen::MatrixXd gram = gram_of(point);
  add_restraint(point, gram);
  if (!gram.allFinite()) return false;
  root = scale_ * factor(std::move(gram));
  return root.rows() > 0 && root.allFinite();
}

void CoupledProblem::add_point(std::size_t point) {
  const CoupledFit& fit = fits_[point];
  Unknowns& unknowns = unknowns_[point];
  unknowns.count = static_cast<int>(fit.influences.size());
  for (const Influence& influence : fit.influences) unknowns.slots.push_back(influence.slot);
  double* const values = values_.data() + values_.size();
  double sum = 0;
  for (const Influence& influence : fit.influences) sum += static_cast<double>(influence.weight);
  for (const Influence& influence : fit.influences)
    values_.push_back(std::sqrt(static_cast<double>(influence.weight) / sum));
  unknowns.roots = values;
  if (options_.point.moves_bind) {
    const Eigen::Vector3d offset = fit.position - points_[point].position;
    values_.insert(values_.end(), offset.begin(), offset.end());
    unknowns.offset = values + unknowns.count;
  }
  RowMajor root;
  if (unknowns.count == 0 || !find_root(point, root)) {
    unknowns.count = 0;
    return;
  }
  problem_->AddParameterBlock(unknowns.roots, unknowns.count);
  if (unknowns.count > 1)
    problem_->SetManifold(unknowns.roots, sphere(unknowns.count));
  else
    problem_->SetParameterBlockConstant(unknowns.roots);
  std::vector<double*> blocks = {unknowns.roots};
  if (unknowns.offset != nullptr) {
    blocks.push_back(unknowns.offset);
    problem_->AddParameterBlock(unknowns.offset, 3);
    if (!points_[point].may_move) problem_->SetParameterBlockConstant(unknowns.offset);
  }
  parts_.point_costs.emplace_back(std::move(root), unknowns);
  problem_->AddResidualBlock(&parts_.point_costs.back(), nullptr, blocks);
  has_unknowns_ = has_unknowns_ || unknowns.count > 1 ||
                  (unknowns.offset != nullptr && points_[point].may_move);
}

void CoupledProblem::add_neighbours(std::size_t a, std::uint32_t b, double of_offset,
                                    double of_change) {
  const Unknowns nothing;
  const Unknowns& of_a = unknowns_[a];
  const Unknowns& of_b = b == kNone ? nothing : unknowns_[b];
  std::vector<ChangeOfSlot> changes;
  const auto add = [&](std::uint32_t slot, int in_a, int in_b) {
    const double before = weight_before(a, slot) - (b == kNone ? 0.0 : weight_before(b, slot));
    changes.push_back({in_a, in_b, -before});
  };
  // Slots that neither point has any more are a constant.
  for (int i = 0; i < of_a.count; ++i) add(of_a.slot(i), i, of_b.find(of_a.slot(i)));
  for (int j = 0; j < of_b.count; ++j)
    if (of_a.find(of_b.slot(j)) < 0) add(of_b.slot(j), -1, j);
  std::vector<double*> blocks;
  for (const Unknowns* unknowns : {&of_a, &of_b}) {
    if (unknowns->count == 0) continue;
    blocks.push_back(unknowns->roots);
    if (unknowns->offset != nullptr) blocks.push_back(unknowns->offset);
  }
  parts_.neighbour_costs.emplace_back(of_a, of_b, std::move(changes), scale_ * of_offset,
                                      scale_ * of_change);
  problem_->AddResidualBlock(&parts_.neighbour_costs.back(), nullptr, blocks);
}

void CoupledProblem::couple(std::span<const RefitNeighbours> neighbours) {
  if (options_.smoothness == 0) return;
  const auto is_fitted = [&](std::uint32_t point) {
    return point != kNone && unknowns_[point].count > 0;
  };
  // All untorn neighbours of a point cause the same kind of cost, so their costs are added.
  struct UntornCost {
    double offset = 0, change = 0;
  };
  std::vector<UntornCost> untorn(points_.size());
  for (const RefitNeighbours& pair : neighbours) {
    if (pair.a == pair.b) continue;
    if (is_fitted(pair.a) && is_fitted(pair.b)) {
      add_neighbours(pair.a, pair.b, std::sqrt(options_.smoothness),
                     std::sqrt(options_.smoothness) * pair.length);
      continue;
    }
    for (const std::uint32_t point : {pair.a, pair.b}) {
      if (!is_fitted(point)) continue;
      untorn[point].offset += options_.smoothness;
      untorn[point].change += options_.smoothness * pair.length * pair.length;
    }
  }
  for (std::size_t point = 0; point < points_.size(); ++point)
    if (untorn[point].offset > 0)
      add_neighbours(point, kNone, std::sqrt(untorn[point].offset),
                     std::sqrt(untorn[point].change));
}

bool CoupledProblem::solve() {
  if (!has_unknowns_) return false;
  ceres::Solver::Options options;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = kMostSteps;
  options.function_tolerance = kLeastGain;
  // Eigen's factorisation is as fast as SuiteSparse's on a band like that of a lip, and its bits do
  // not depend on a BLAS.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.dense_linear_algebra_library_type = ceres::EIGEN;
  options.linear_solver_type = ceres::IsSparseLinearAlgebraLibraryTypeAvailable(ceres::EIGEN_SPARSE)
                                   ? ceres::SPARSE_NORMAL_CHOLESKY
                                   : ceres::DENSE_QR;
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem_.get(), &summary);
  return summary.IsSolutionUsable() &&
         std::all_of(values_.begin(), values_.end(),
                     [](double value) { return std::isfinite(value); });
}

/// Replaces the fit of a point alone by the common one, or by the farthest of a few places on the
/// way to it at which no bound is exceeded.
void CoupledProblem::take_solution() {
  for (std::size_t point = 0; point < points_.size(); ++point) {
    const Unknowns& unknowns = unknowns_[point];
    if (unknowns.count == 0) continue;
    weights::centre_terms(*points_[point].exact, moments_, terms_);
    weights::weights_of_terms(terms_, fits_[point].influences, alone_);
    together_.assign(terms_.size(), 0.0);
    for (std::size_t i = 0; i < terms_.size(); ++i)
      if (const int k = unknowns.find(terms_[i].slot); k >= 0)
        together_[i] = unknowns.roots[k] * unknowns.roots[k];
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
    if (unknowns.offset != nullptr)
      way = points_[point].position + Eigen::Map<const Eigen::Vector3d>(unknowns.offset) -
            Eigen::Vector3d(fits_[point].position);
    for (const double share : kShares)
      if (take_share(point, share, way)) break;
  }
}

/// Takes a point between its fit alone and the common one.
/// @return false if it exceeds a bound there.
bool CoupledProblem::take_share(std::size_t point, double share, const Eigen::Vector3d& way) {
  CoupledFit fit = fits_[point];
  of_terms_.resize(terms_.size());
  for (std::size_t i = 0; i < terms_.size(); ++i)
    of_terms_[i] = alone_[i] + share * (together_[i] - alone_[i]);
  weights::store_weights(terms_, of_terms_, fit.influences);
  weights::weights_of_terms(terms_, fit.influences, of_terms_);
  fit.position += share * way;
  weights::differences(terms_, of_terms_, fit.position - moments_.centre(), difference_);
  fit.mean_square = moments_.mean_square(difference_, options_.point.group);
  fit.is_better = fit.mean_square < fit.barycentric_mean_square;
  if (!fit.is_better || weights::exceeds_bounds(points_[point], moments_, difference_, excess_))
    return false;
  fits_[point] = std::move(fit);
  return true;
}

Status check(std::span<const PointToRefit> points, std::span<const RefitNeighbours> neighbours,
             const CoupledRefitOptions& options, const PoseMoments& moments) {
  if (!std::isfinite(options.smoothness) || options.smoothness < 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the smoothness is %g; it must be finite and not below 0",
                           options.smoothness);
  if (moments.pose_count(options.point.group) == 0)
    return Status::failure(StatusCode::empty_input, kNone, "the moments contain no pose");
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const RefitNeighbours& pair = neighbours[i];
    const auto index = static_cast<std::uint32_t>(i);
    for (const std::uint32_t point : {pair.a, pair.b == kNone ? pair.a : pair.b})
      if (point >= points.size())
        return Status::failure(StatusCode::index_out_of_range, index,
                               "neighbours %u: point %u does not exist; there are %zu", index,
                               point, points.size());
    if (!std::isfinite(pair.length) || pair.length < 0)
      return Status::failure(StatusCode::invalid_argument, index,
                             "neighbours %u: their length is %g; it must be finite and not below 0",
                             index, pair.length);
  }
  return {};
}

/// As refit_coupled().
Result<std::vector<CoupledFit>> solve_coupled(std::span<const PointToRefit> points,
                                              std::span<const RefitNeighbours> neighbours,
                                              const CoupledRefitOptions& options,
                                              const PoseMoments& moments) {
  if (const Status status = check(points, neighbours, options, moments); !status) return status;
  try {
    CoupledProblem problem(points, options, moments);
    problem.couple(neighbours);
    if (problem.solve()) problem.take_solution();
    return problem.take_fits();
  } catch (const std::exception& error) {
    return Status::failure(StatusCode::internal_error, kNone, "Ceres: %s", error.what());
  }
}

}  // namespace

void use_coupled_refit() { set_coupled_solver(&solve_coupled); }

}  // namespace sunder
