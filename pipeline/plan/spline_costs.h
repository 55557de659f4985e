#pragma once

#include <array>
#include <vector>

#include <ceres/cost_function.h>

#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/blade_errors.h"
#include "pipeline/plan/clearance.h"
#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// blade_errors() at a sample, of the four control points that count there.
class BladeCost final : public ceres::CostFunction {
 public:
  BladeCost(BladeChain& chain, const TargetSample& sample, const ErrorScales& scales,
            const std::array<double, 4>& weights);
  bool Evaluate(double const* const* control, double* errors, double** rates) const override;

 private:
  BladeChain& chain_;
  const TargetSample& sample_;
  ErrorScales scales_;
  std::array<double, 4> weights_;
};

/// By how much a link's shape is nearer to a place of the character than the margin, divided by a
/// scale; 0 beyond it.
class ClearanceCost final : public ceres::CostFunction {
 public:
  ClearanceCost(BladeChain& chain, const BoneCollider& shape, const NearPlace& near, double margin,
                double scale, const std::array<double, 4>& weights);
  bool Evaluate(double const* const* control, double* errors, double** rates) const override;

 private:
  BladeChain& chain_;
  const BoneCollider& shape_;
  NearPlace near_;
  double margin_, scale_;
  std::array<double, 4> weights_;
};

/// Weighted sums of control points, each value times its own factor:
/// errors[i] = factors[i] * (sum_k stencil[k] * control[k][i] - offset[i]).
class StencilCost final : public ceres::CostFunction {
 public:
  StencilCost(std::vector<double> stencil, Values factors, Values offset);
  bool Evaluate(double const* const* control, double* errors, double** rates) const override;

 private:
  std::vector<double> stencil_;
  Values factors_, offset_;
};

/// By which share of bounds[i] such sums, sum_k stencil[k] * control[k][i], exceed it, divided by
/// `scale`; 0 within bounds.
class ExcessCost final : public ceres::CostFunction {
 public:
  ExcessCost(std::vector<double> stencil, Values bounds, double scale);
  bool Evaluate(double const* const* control, double* errors, double** rates) const override;

 private:
  std::vector<double> stencil_;
  Values bounds_;  ///< > 0; infinity: none.
  double scale_;
};

}  // namespace sunder::plan
