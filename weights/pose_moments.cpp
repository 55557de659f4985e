#include "weights/internal/pose_moments.h"

#include <algorithm>

#include "core/internal/ordered.h"

namespace sunder {
namespace {

/// The sum of the products of all coefficients: per row first, because rows are added side by side.
double sum_of_products(const PoseMoments::Matrix& a, const PoseMoments::Matrix& b) {
  Eigen::Array<double, 4, 1, Eigen::DontAlign> of_rows = a.col(0).array() * b.col(0).array();
  for (int column = 1; column < 4; ++column)
    of_rows += a.col(column).array() * b.col(column).array();
  return ((of_rows[0] + of_rows[1]) + of_rows[2]) + of_rows[3];
}

}  // namespace

PoseMoments::PoseMoments(std::size_t slots, const Vec3d& centre, std::size_t groups)
    : centre_(centre), rows_(slots), centred_(slots), pose_counts_(groups, 0) {}

void PoseMoments::want(const AnimationPoint& point) {
  for (const AnimationPoint::Term& a : point.terms())
    for (const AnimationPoint::Term& b : point.terms()) {
      if (b.slot < a.slot) continue;
      std::vector<Entry>& row = rows_[a.slot];
      const auto known = std::find_if(row.begin(), row.end(),
                                      [&](const Entry& entry) { return entry.slot == b.slot; });
      if (known != row.end()) continue;
      if (a.slot == b.slot) slots_.push_back(a.slot);
      row.push_back({b.slot, static_cast<std::uint32_t>(pairs_.size())});
      pairs_.push_back({a.slot, b.slot});
    }
}

void PoseMoments::add(std::span<const Affine3d> model_from_bind, std::size_t group, double weight) {
  if (moments_.empty()) moments_.resize(pairs_.size() * group_count(), Matrix::Zero());
  ++pose_counts_[group];
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::uint32_t slot : slots_) {
    centred_[slot].leftCols<3>() = model_from_bind[slot].linear();
    centred_[slot].col(3) = transform(model_from_bind[slot], centre_);
    mean += centred_[slot].col(3);
  }
  if (!slots_.empty()) mean /= static_cast<double>(slots_.size());
  for (const std::uint32_t slot : slots_) centred_[slot].col(3) -= mean;
  Matrix* const of_group = moments_.data() + group * pairs_.size();
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    of_group[i] += weight * multiply(centred_[pairs_[i].low].transpose(), centred_[pairs_[i].high]);
}

void PoseMoments::combine(std::span<const double> factors, std::size_t into) {
  if (moments_.empty()) moments_.resize(pairs_.size() * group_count(), Matrix::Zero());
  Matrix* const sums = moments_.data() + into * pairs_.size();
  std::fill(sums, sums + pairs_.size(), Matrix::Zero());
  for (std::size_t group = 0; group < group_count(); ++group) {
    if (group == into || factors[group] == 0 || pose_counts_[group] == 0) continue;
    const double factor = factors[group] / static_cast<double>(pose_counts_[group]);
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      sums[i] += factor * moments_[group * pairs_.size() + i];
  }
  pose_counts_[into] = 1;
}

double PoseMoments::mean_square(std::span<const AnimationPoint::Term> difference,
                                std::size_t group) const {
  if (pose_counts_[group] == 0) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < difference.size(); ++i)
    for (std::size_t j = i; j < difference.size(); ++j) {
      const bool is_ascending = difference[i].slot <= difference[j].slot;
      const AnimationPoint::Term &low = difference[is_ascending ? i : j],
                                 &high = difference[is_ascending ? j : i];
      const double product = dot(low.q, multiply(of(low.slot, high.slot, group), high.q));
      sum += i == j ? product : 2 * product;
    }
  return std::max(sum, 0.0) / static_cast<double>(pose_counts_[group]);
}

void PoseMoments::mean_squares(std::span<const AnimationPoint::Term> difference,
                               std::span<double> of_groups) const {
  std::fill(of_groups.begin(), of_groups.end(), 0.0);
  if (moments_.empty()) return;
  for (std::size_t i = 0; i < difference.size(); ++i)
    for (std::size_t j = i; j < difference.size(); ++j) {
      const bool is_ascending = difference[i].slot <= difference[j].slot;
      const AnimationPoint::Term &low = difference[is_ascending ? i : j],
                                 &high = difference[is_ascending ? j : i];
      Matrix products;
      for (int column = 0; column < 4; ++column)
        products.col(column) = (i == j ? 1.0 : 2.0) * high.q[column] * low.q;
      const Matrix* moment = moments_.data() + pair_of(low.slot, high.slot);
      for (double& of_group : of_groups) {
        of_group += sum_of_products(products, *moment);
        moment += pairs_.size();
      }
    }
  for (std::size_t group = 0; group < of_groups.size(); ++group)
    of_groups[group] = std::max(of_groups[group], 0.0) /
                       static_cast<double>(std::max<std::size_t>(pose_counts_[group], 1));
}

}  // namespace sunder
