#include "pipeline/plan/gape_profile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Core>

namespace sunder::plan {
namespace {

constexpr int kFineSteps = 200;    ///< Of each step, for integrals.
constexpr int kSweeps = 400;       ///< Of the least squares.
constexpr double kDamping = 1e-3;  ///< Tension that is not needed is small.

/// The opening of a crack from -1 to 1 at the nodes by forces on its lips that are 1 at one node
/// and 0 at the others, over the one in the middle by forces of 1 everywhere (the Green's function
/// of a crack in a sheet; its integral is pi sqrt(1 - x^2)).
Eigen::MatrixXd flat_openings() {
  constexpr int kFine = kGapeSteps * kFineSteps;
  Eigen::MatrixXd openings = Eigen::MatrixXd::Zero(kGapeSteps + 1, kGapeSteps + 1);
  for (int i = 1; i < kGapeSteps; ++i) {
    const double x = -1 + 2.0 * i / kGapeSteps;
    for (int k = 0; k < kFine; ++k) {
      const double at = (k + 0.5) / kFineSteps;  // in steps, never at a node
      const double c = -1 + 2 * at / kGapeSteps;
      const double root = std::sqrt((1 - x * x) * (1 - c * c));
      const double opening = std::log(std::abs((1 - x * c + root) / (x - c))) * 2.0 / kFine;
      const int node = static_cast<int>(at);
      const double part = at - node;
      openings(i, node) += (1 - part) * opening / std::numbers::pi;
      openings(i, node + 1) += part * opening / std::numbers::pi;
    }
  }
  return openings;
}

}  // namespace

std::vector<double> flat_tension(std::span<const double> wanted) {
  const Eigen::MatrixXd openings = flat_openings();
  const Eigen::Map<const Eigen::VectorXd> aim(wanted.data(), kGapeSteps + 1);
  Eigen::MatrixXd normal = openings.transpose() * openings;
  normal.diagonal().array() += kDamping * normal.diagonal().maxCoeff();
  const Eigen::VectorXd right = openings.transpose() * aim;
  Eigen::VectorXd tension = Eigen::VectorXd::Zero(kGapeSteps + 1);
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (Eigen::Index i = 0; i <= kGapeSteps; ++i) {
      const double rest = right[i] - normal.row(i) * tension;
      tension[i] = std::max(0.0, tension[i] + rest / normal(i, i));
    }
  return {tension.data(), tension.data() + tension.size()};
}

double profile_at_share(std::span<const double> nodes, double share) {
  const double at = std::clamp(share, 0.0, 1.0) * kGapeSteps;
  const auto node = std::min(static_cast<std::size_t>(at), std::size_t{kGapeSteps - 1});
  const double part = at - static_cast<double>(node);
  return (1 - part) * nodes[node] + part * nodes[node + 1];
}

std::vector<double> profile_of(std::span<const ProfileSample> samples) {
  std::vector<double> nodes(kGapeSteps + 1), weights(kGapeSteps + 1);
  for (const ProfileSample& sample : samples)
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double weight = 1 - std::abs(sample.share * kGapeSteps - static_cast<double>(i));
      if (weight <= 0) continue;
      nodes[i] += weight * sample.value;
      weights[i] += weight;
    }
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (weights[i] > 0) nodes[i] /= weights[i];
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i)
    if (weights[i] <= 0) nodes[i] = 0.5 * (nodes[i - 1] + nodes[i + 1]);
  nodes.front() = nodes.back() = 0;  // where the wound is closed
  return nodes;
}

}  // namespace sunder::plan
