#include "weights/point_forms.h"

#include <algorithm>

#include "core/internal/ordered.h"

namespace sunder::weights {

using Vec4 = Eigen::Vector4d;

void PointForms::begin(std::span<const AnimationPoint::Term> terms, const PoseMoments& moments,
                       std::size_t group) {
  terms_ = terms;
  const std::size_t n = terms.size();
  const double per_pose =
      1.0 / static_cast<double>(std::max<std::size_t>(moments.pose_count(group), 1));
  between_.resize(n * n);
  towards_.resize(n);
  for (auto& towards : towards_) towards.setZero();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) {
      PoseMoments::Matrix& here = between_[i * n + j];
      if (terms[i].slot > terms[j].slot)
        here = per_pose * moments.of(terms[j].slot, terms[i].slot, group).transpose();
      else
        here = per_pose * moments.of(terms[i].slot, terms[j].slot, group);
      towards_[i] += multiply(here, terms[j].q);
      if (i != j) towards_[j] += multiply(here.transpose(), terms[i].q);
    }
  target_square_ = 0;
  for (std::size_t i = 0; i < n; ++i) target_square_ += dot(terms[i].q, towards_[i]);
}

double PointForms::mean_square(std::span<const double> of_terms,
                               const Eigen::Vector3d& position) const {
  // The differences w_i [x; 1] - q_i, because the parts of the square alone cancel.
  const auto difference = [&](std::size_t i) -> Vec4 {
    const double weight = of_terms[i];
    return Vec4(weight * position.x(), weight * position.y(), weight * position.z(), weight) -
           Vec4(terms_[i].q);
  };
  double sum = 0;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    Vec4 carried = multiply(between(i, i), difference(i));
    for (std::size_t j = i + 1; j < terms_.size(); ++j)
      carried += 2.0 * multiply(between(i, j), difference(j));
    sum += dot(difference(i), carried);
  }
  return std::max(sum, 0.0);
}

double PointForms::add_to_gram(const Eigen::Vector3d& position, double factor,
                               SimplexSolver& solver) {
  const std::size_t n = terms_.size();
  const Vec4 at(position.x(), position.y(), position.z(), 1.0);
  projected_.resize(n);
  for (std::size_t i = 0; i < n; ++i) projected_[i] = dot(at, towards_[i]);
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) {
      const double product = dot(at, multiply(between(i, j), at));
      if (i == j) largest = std::max(largest, factor * product);
      const double added = factor * (product - projected_[i] - projected_[j] + target_square_);
      solver.gram(i, j) += added;
      if (i != j) solver.gram(j, i) = solver.gram(i, j);
    }
  return largest;
}

void PointForms::add_to_equations(std::span<const double> of_terms, double factor,
                                  Eigen::Matrix3d& left, Eigen::Vector3d& right) const {
  Eigen::Matrix4d square = Eigen::Matrix4d::Zero();
  Vec4 towards = Vec4::Zero();
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (of_terms[i] == 0) continue;
    towards += of_terms[i] * towards_[i];
    for (std::size_t j = i; j < terms_.size(); ++j)
      if (of_terms[j] != 0)
        square += (i == j ? 1.0 : 2.0) * of_terms[i] * of_terms[j] * between(i, j);
  }
  square = (0.5 * factor) * (square + square.transpose()).eval();
  left += square.topLeftCorner<3, 3>();
  right += factor * towards.head<3>() - square.topRightCorner<3, 1>();
}

}  // namespace sunder::weights
