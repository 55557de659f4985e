#include "pipeline/validation/transfer/inpaint.h"

#include <algorithm>
#include <limits>
#include <queue>

#include <Eigen/SparseCholesky>

#include "core/internal/ordered.h"

namespace sunder::validation {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Neighbours = Sparse::InnerIterator;

int row_number(Index index) { return static_cast<int>(index); }

/// The rows of Q that belong to unknown points.
Sparse energy_rows(const Laplacian& laplacian, double smoothness,
                   const std::vector<Index>& unknown) {
  const Eigen::Index count = laplacian.stiffness.rows();
  std::vector<Eigen::Triplet<double>> chosen;
  for (Index u = 0; u < unknown.size(); ++u)
    chosen.emplace_back(row_number(u), row_number(unknown[u]), 1.0);
  Sparse choice(static_cast<Eigen::Index>(unknown.size()), count);
  choice.setFromTriplets(chosen.begin(), chosen.end());
  const Sparse own = choice * laplacian.stiffness;
  Sparse over_mass = own;
  for (int r = 0; r < over_mass.outerSize(); ++r)
    for (Neighbours at(over_mass, r); at; ++at)
      at.valueRef() *= smoothness / laplacian.mass[static_cast<std::size_t>(at.col())];
  const Sparse twice = over_mass * laplacian.stiffness;
  return own + twice;
}

/// The columns of unknown points, and the right-hand side that the fixed ones make.
struct System {
  Eigen::SparseMatrix<double> matrix;
  std::vector<Index> bones;  ///< Per column of `right`.
  Eigen::MatrixXd right;
};

System make_system(const Sparse& energy, const std::vector<Index>& number_of,
                   const std::vector<WeightRow>& rows) {
  System system;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<std::vector<std::pair<int, double>>> right;  // per bone
  std::vector<Index> column_of;
  for (int u = 0; u < energy.outerSize(); ++u)
    for (Neighbours at(energy, u); at; ++at) {
      const auto point = static_cast<Index>(at.col());
      if (number_of[point] != kNone) {
        entries.emplace_back(u, row_number(number_of[point]), at.value());
        continue;
      }
      for (const BoneWeight& entry : rows[point]) {
        if (entry.bone >= column_of.size()) column_of.resize(entry.bone + 1, kNone);
        if (column_of[entry.bone] == kNone) {
          column_of[entry.bone] = static_cast<Index>(right.size());
          right.emplace_back();
        }
        right[column_of[entry.bone]].emplace_back(u, -at.value() * entry.weight);
      }
    }
  const Eigen::Index count = energy.rows();
  system.matrix.resize(count, count);
  system.matrix.setFromTriplets(entries.begin(), entries.end());
  for (Index bone = 0; bone < column_of.size(); ++bone)
    if (column_of[bone] != kNone) system.bones.push_back(bone);
  system.right.setZero(count, static_cast<Eigen::Index>(system.bones.size()));
  for (std::size_t c = 0; c < system.bones.size(); ++c)
    for (const auto& [u, value] : right[column_of[system.bones[c]]])
      system.right(u, static_cast<Eigen::Index>(c)) += value;
  return system;
}

}  // namespace

bool inpaint(const Laplacian& laplacian, double smoothness, std::span<const PointState> states,
             std::vector<WeightRow>& rows) {
  std::vector<Index> unknown, number_of(states.size(), kNone);
  for (Index point = 0; point < states.size(); ++point)
    if (states[point] == PointState::unknown) {
      number_of[point] = static_cast<Index>(unknown.size());
      unknown.push_back(point);
    }
  if (unknown.empty()) return true;
  const System system = make_system(energy_rows(laplacian, smoothness, unknown), number_of, rows);
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(system.matrix);
  if (factors.info() != Eigen::Success) return false;
  std::vector<WeightRow> solved(unknown.size());
  for (std::size_t c = 0; c < system.bones.size(); ++c) {
    const Eigen::VectorXd column = factors.solve(system.right.col(static_cast<Eigen::Index>(c)));
    if (!column.allFinite()) return false;
    for (std::size_t u = 0; u < unknown.size(); ++u)
      if (const double weight = column[static_cast<Eigen::Index>(u)]; weight != 0)
        solved[u].push_back({system.bones[c], weight});
  }
  for (std::size_t u = 0; u < unknown.size(); ++u) rows[unknown[u]] = std::move(solved[u]);
  return true;
}

void smooth(const Laplacian& laplacian, const std::vector<bool>& is_smoothed, std::uint32_t sweeps,
            double strength, std::vector<WeightRow>& rows) {
  for (std::uint32_t sweep = 0; sweep < sweeps; ++sweep) {
    std::vector<WeightRow> next = rows;
    for (Index point = 0; point < rows.size(); ++point) {
      if (!is_smoothed[point]) continue;
      WeightRow mean;
      double count = 0;
      for (Neighbours at(laplacian.stiffness, row_number(point)); at; ++at)
        if (static_cast<Index>(at.col()) != point) {
          add(mean, 1, rows[static_cast<std::size_t>(at.col())]);
          ++count;
        }
      if (count == 0) continue;
      WeightRow smoothed;
      add(smoothed, 1 - strength, rows[point]);
      add(smoothed, strength / count, mean);
      next[point] = std::move(smoothed);
    }
    rows = std::move(next);
  }
}

std::vector<bool> points_near_unknown(const Laplacian& laplacian, std::span<const Vec3d> positions,
                                      std::span<const PointState> states, double distance) {
  using Front = std::pair<double, Index>;
  std::priority_queue<Front, std::vector<Front>, std::greater<>> front;
  std::vector<double> reached(positions.size(), std::numeric_limits<double>::infinity());
  for (Index point = 0; point < states.size(); ++point)
    if (states[point] == PointState::unknown) {
      reached[point] = 0;
      front.emplace(0.0, point);
    }
  while (!front.empty()) {
    const auto [way, point] = front.top();
    front.pop();
    if (way > reached[point]) continue;
    for (Neighbours at(laplacian.stiffness, row_number(point)); at; ++at) {
      const auto next = static_cast<Index>(at.col());
      const double longer = way + norm(positions[next] - positions[point]);
      if (longer > distance || longer >= reached[next]) continue;
      reached[next] = longer;
      front.emplace(longer, next);
    }
  }
  std::vector<bool> is_near;
  for (const double way : reached) is_near.push_back(way <= distance);
  return is_near;
}

}  // namespace sunder::validation
