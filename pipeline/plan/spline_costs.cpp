#include "pipeline/plan/spline_costs.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sunder::plan {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

double stencil_sum(const std::vector<double>& stencil, double const* const* control,
                   Eigen::Index i) {
  double sum = 0;
  for (std::size_t k = 0; k < stencil.size(); ++k) sum += stencil[k] * control[k][i];
  return sum;
}

}  // namespace

BladeCost::BladeCost(BladeChain& chain, const TargetSample& sample, const ErrorScales& scales,
                     const std::array<double, 4>& weights)
    : chain_(chain), sample_(sample), scales_(scales_at(scales, sample)), weights_(weights) {
  set_num_residuals(7);
  mutable_parameter_block_sizes()->assign(4, static_cast<int>(chain.size()));
}

bool BladeCost::Evaluate(double const* const* control, double* errors, double** rates) const {
  const auto count = static_cast<Eigen::Index>(chain_.size());
  Values values = Values::Zero(count);
  for (std::size_t k = 0; k < 4; ++k)
    values += weights_[k] * Eigen::Map<const Values>(control[k], count);
  BladePlace place;
  chain_.place({values.data(), chain_.size()}, place, rates != nullptr);
  ErrorRates by_value;
  const BladeErrors found =
      blade_errors(place, sample_, scales_, rates != nullptr ? &by_value : nullptr);
  std::copy(found.data(), found.data() + found.size(), errors);
  for (std::size_t k = 0; rates != nullptr && k < 4; ++k)
    if (rates[k] != nullptr) Eigen::Map<RowMajor>(rates[k], 7, count) = weights_[k] * by_value;
  return found.allFinite();
}

ClearanceCost::ClearanceCost(BladeChain& chain, const BoneCollider& shape, const NearPlace& near,
                             double margin, double scale, const std::array<double, 4>& weights)
    : chain_(chain), shape_(shape), near_(near), margin_(margin), scale_(scale), weights_(weights) {
  set_num_residuals(1);
  mutable_parameter_block_sizes()->assign(4, static_cast<int>(chain.size()));
}

bool ClearanceCost::Evaluate(double const* const* control, double* errors, double** rates) const {
  const auto count = static_cast<Eigen::Index>(chain_.size());
  Values values = Values::Zero(count);
  for (std::size_t k = 0; k < 4; ++k)
    values += weights_[k] * Eigen::Map<const Values>(control[k], count);
  BladePlace blade;
  chain_.place({values.data(), chain_.size()}, blade, false);
  const Collider collider = posed_collider(shape_, chain_.frames()[shape_.bone]);
  const bool is_below = near_.normal.squaredNorm() > 0;
  const SurfaceDistance of_shape = distance_to(collider, near_.place);
  const double distance =
      is_below ? (collider.place - near_.place).dot(near_.normal) : of_shape.distance;
  errors[0] = std::max(0.0, margin_ - distance) / scale_;
  Eigen::RowVectorXd by_value = Eigen::RowVectorXd::Zero(count);
  if (rates != nullptr && errors[0] > 0) {
    // The shape moves away from the place against its normal.
    const Vec3d away = is_below ? near_.normal : Vec3d(-of_shape.normal);
    const Vec3d at = is_below ? collider.place : near_.place;
    by_value = -away.transpose() * chain_.rates_of(shape_.bone, at) / scale_;
  }
  for (std::size_t k = 0; rates != nullptr && k < 4; ++k)
    if (rates[k] != nullptr)
      Eigen::Map<Eigen::RowVectorXd>(rates[k], count) = weights_[k] * by_value;
  return std::isfinite(errors[0]);
}

StencilCost::StencilCost(std::vector<double> stencil, Values factors, Values offset)
    : stencil_(std::move(stencil)), factors_(std::move(factors)), offset_(std::move(offset)) {
  set_num_residuals(static_cast<int>(factors_.size()));
  mutable_parameter_block_sizes()->assign(stencil_.size(), static_cast<int>(factors_.size()));
}

bool StencilCost::Evaluate(double const* const* control, double* errors, double** rates) const {
  const Eigen::Index count = factors_.size();
  for (Eigen::Index i = 0; i < count; ++i)
    errors[i] = factors_[i] * (stencil_sum(stencil_, control, i) - offset_[i]);
  for (std::size_t k = 0; rates != nullptr && k < stencil_.size(); ++k)
    if (rates[k] != nullptr)
      Eigen::Map<RowMajor>(rates[k], count, count) = (stencil_[k] * factors_).asDiagonal();
  return true;
}

ExcessCost::ExcessCost(std::vector<double> stencil, Values bounds, double scale)
    : stencil_(std::move(stencil)), bounds_(std::move(bounds)), scale_(scale) {
  set_num_residuals(static_cast<int>(bounds_.size()));
  mutable_parameter_block_sizes()->assign(stencil_.size(), static_cast<int>(bounds_.size()));
}

bool ExcessCost::Evaluate(double const* const* control, double* errors, double** rates) const {
  const Eigen::Index count = bounds_.size();
  Values signs = Values::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double sum = stencil_sum(stencil_, control, i);
    const double excess = std::abs(sum) / bounds_[i] - 1;
    errors[i] = std::max(excess, 0.0) / scale_;
    if (excess > 0) signs[i] = (sum > 0 ? 1 : -1) / (scale_ * bounds_[i]);
  }
  for (std::size_t k = 0; rates != nullptr && k < stencil_.size(); ++k)
    if (rates[k] != nullptr)
      Eigen::Map<RowMajor>(rates[k], count, count) = (stencil_[k] * signs).asDiagonal();
  return true;
}

}  // namespace sunder::plan
