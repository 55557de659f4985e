#include "weights/internal/pose_moments.h"

#include <algorithm>

#include "core/internal/ordered.h"

namespace sunder {

PoseMoments::PoseMoments(std::size_t slots, const Vec3d& centre)
    : centre_(centre), rows_(slots), centred_(slots) {}

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
      moments_.emplace_back(Matrix::Zero());
    }
}

void PoseMoments::add(std::span<const Affine3d> model_from_bind) {
  ++pose_count_;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::uint32_t slot : slots_) {
    centred_[slot].leftCols<3>() = model_from_bind[slot].linear();
    centred_[slot].col(3) = transform(model_from_bind[slot], centre_);
    mean += centred_[slot].col(3);
  }
  if (!slots_.empty()) mean /= static_cast<double>(slots_.size());
  for (const std::uint32_t slot : slots_) centred_[slot].col(3) -= mean;
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    moments_[i] += multiply(centred_[pairs_[i].low].transpose(), centred_[pairs_[i].high]);
}

double PoseMoments::mean_square(std::span<const AnimationPoint::Term> difference) const {
  double sum = 0;
  for (std::size_t i = 0; i < difference.size(); ++i)
    for (std::size_t j = i; j < difference.size(); ++j) {
      const bool is_ascending = difference[i].slot <= difference[j].slot;
      const AnimationPoint::Term &low = difference[is_ascending ? i : j],
                                 &high = difference[is_ascending ? j : i];
      const double product = dot(low.q, multiply(of(low.slot, high.slot), high.q));
      sum += i == j ? product : 2 * product;
    }
  return pose_count_ > 0 ? std::max(sum, 0.0) / static_cast<double>(pose_count_) : 0.0;
}

}  // namespace sunder
