#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace sunder::tools {

/// Smooths values at sections of a wound along it, as heat spreads, over a distance in metres: how
/// many sections there are on the way makes no difference, so that short edges make no step.
class SmoothAlong {
 public:
  struct Edge {
    std::uint32_t a = 0, b = 0;  ///< Sections.
    float length = 0;            ///< Metres.
  };

  /// @param is_fixed  per section: it keeps its value.
  /// @param distance  0 changes nothing. O(sections) for wounds that fork little.
  SmoothAlong(std::span<const Edge> edges, const std::vector<bool>& is_fixed, float distance);

  /// @param values  a row per section.
  [[nodiscard]] Eigen::MatrixXd smoothed(const Eigen::MatrixXd& values) const;

 private:
  Eigen::VectorXd held_;  ///< Per section: how strongly it keeps its own value.
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

}  // namespace sunder::tools
