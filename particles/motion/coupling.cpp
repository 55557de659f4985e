#include "particles/motion/coupling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace sunder::particles {
namespace {

/// The damping of a spring, increased if the step does not resolve the spring: otherwise the place
/// at the end of each step is met, but the velocity there alternates for ever.
double damping_of(double stiffness, double damping, double frequency, double seconds) {
  if (frequency * seconds <= 2) return damping;
  return std::max(damping, stiffness * (seconds - 2 / frequency));
}

/// Velocity per distance moved, at the end of a step under a constant acceleration. Not positive if
/// the particle's own spring turns back within the step: then its end velocity does not reflect the
/// force.
double velocity_a_place(const SpringStep& step) {
  return step.place_from_acceleration > 0
             ? step.velocity_from_acceleration() / step.place_from_acceleration
             : 0.0;
}

Eigen::Vector4d padded(const Vec3d& v) { return {v.x(), v.y(), v.z(), 0.0}; }

}  // namespace

/// Gives rows to the particles that move. If these are most of all, the others have rows too, but
/// no springs: then the pattern stays the same when some fall asleep or wake.
void CouplingSolver::find_rows(const Inputs& in) {
  const auto count = static_cast<Index>(in.places.size());
  moves_.assign(count, 0);
  for (const Index p : in.active) moves_[p] = 1;
  if (2 * in.active.size() >= count) {
    rows_.resize(count);
    std::iota(rows_.begin(), rows_.end(), Index{0});
  } else {
    rows_.assign(in.active.begin(), in.active.end());
  }
  row_of_.assign(count, kNone);
  for (Index row = 0; row < rows_.size(); ++row) row_of_[rows_[row]] = row;
}

void CouplingSolver::assemble_springs(const Inputs& in, Index row) {
  const Index p = rows_[row];
  const double ratio = ratios_[in.material_of[p]];
  const Vec3d &place = in.places[p], &velocity = in.velocities[p];
  double ground = in.graph.masses[p] / in.steps[in.material_of[p]].place_from_acceleration;
  Vec3d sum = Vec3d::Zero();
  for (const Spring& spring : in.graph.of(p)) {
    const Index q = spring.other, column = row_of_[q];
    const bool moves = moves_[q] != 0;
    if ((moves && column < row) || !(spring.stiffness > 0)) continue;
    const double other_ratio = moves ? ratios_[in.material_of[q]] : ratio;
    // If a ratio is not positive, the end velocity does not reflect how fast the two separate.
    const double damping =
        std::min(ratio, other_ratio) > 0
            ? damping_of(spring.stiffness, spring.damping, spring.frequency, in.seconds)
            : 0.0;
    const double stiffness = spring.stiffness + damping * std::max(ratio, other_ratio);
    const Vec3d force =
        spring.stiffness * (in.places[q] - place) + damping * (in.velocities[q] - velocity);
    sum += force;
    if (moves) {
      x_[column] -= padded(force);
      add_entry(column, stiffness);
    } else {
      ground += stiffness;
      if (column != kNone && column > row) add_entry(column, 0);
    }
  }
  matrix_.grounds[row] += ground;
  x_[row] += padded(sum);
}

/// The row of a particle that does not move.
void CouplingSolver::assemble_still(const Inputs& in, Index row) {
  for (const Spring& spring : in.graph.of(rows_[row]))
    if (row_of_[spring.other] > row && spring.stiffness > 0) add_entry(row_of_[spring.other], 0);
  matrix_.grounds[row] = 1;
}

void CouplingSolver::assemble_pull(const Inputs& in, const PointPull& pull) {
  std::array<Index, PointPull::kMost> rows = {};
  std::array<double, PointPull::kMost> weights = {};
  std::size_t count = 0;
  double least = std::numeric_limits<double>::infinity(), greatest = 0;
  Vec3d place = -pull.target, velocity = Vec3d::Zero();
  for (std::size_t k = 0; k < PointPull::kMost; ++k) {
    if (pull.weights[k] == 0) continue;
    const Index p = pull.particles[k];
    place += pull.weights[k] * in.places[p];
    velocity += pull.weights[k] * in.velocities[p];
    if (moves_[p] == 0) continue;
    rows[count] = row_of_[p];
    weights[count++] = pull.weights[k];
    const double ratio = ratios_[in.material_of[p]];
    least = std::min(least, ratio);
    greatest = std::max(greatest, ratio);
  }
  // The requested stiffness, always well damped: at least critically, and as in an implicit Euler
  // step if that is not resolved.
  const double critical = pull.frequency > 0 ? 2 * pull.stiffness / pull.frequency : 0.0;
  const double damping = least > 0 ? std::max(critical, pull.stiffness * in.seconds) : 0.0;
  const double stiffness = pull.stiffness + damping * greatest;
  const Vec4 force = -padded(pull.stiffness * place + damping * velocity);
  if (count == 0 || !(stiffness > 0)) return;
  if (count == 1) {
    matrix_.grounds[rows[0]] += weights[0] * weights[0] * stiffness;
    x_[rows[0]] += weights[0] * force;
    return;
  }
  const auto row_of_pull = static_cast<Index>(matrix_.grounds.size() + matrix_.compliances.size());
  for (std::size_t k = 0; k < count; ++k)
    pull_entries_.push_back({rows[k], row_of_pull, weights[k]});
  matrix_.compliances.push_back(1 / stiffness);
  x_.push_back(force / -stiffness);
}

void CouplingSolver::assemble(const Inputs& in) {
  find_rows(in);
  const std::size_t rows = rows_.size();
  ratios_.clear();
  for (const SpringStep& step : in.steps) ratios_.push_back(velocity_a_place(step));
  x_.reserve(rows + in.pulls.size());
  x_.assign(rows, Vec4::Zero());
  matrix_.grounds.assign(rows, 0.0);
  matrix_.compliances.clear();
  pull_entries_.clear();
  for (const PointPull& pull : in.pulls) assemble_pull(in, pull);
  std::sort(pull_entries_.begin(), pull_entries_.end(), [](const auto& a, const auto& b) {
    return std::tie(a.row, a.column) < std::tie(b.row, b.column);
  });

  auto& [first, columns, pulls] = matrix_.pattern;
  const std::size_t most = in.graph.springs.size() / 2 + PointPull::kMost * in.pulls.size();
  first.assign(1, 0);
  columns.clear();
  columns.reserve(most);
  matrix_.values.clear();
  matrix_.values.reserve(most);
  auto entry = pull_entries_.begin();
  for (Index row = 0; row < rows; ++row) {
    if (moves_[rows_[row]] != 0)
      assemble_springs(in, row);
    else
      assemble_still(in, row);
    for (; entry != pull_entries_.end() && entry->row == row; ++entry)
      add_entry(entry->column, entry->weight);
    first.push_back(static_cast<Index>(columns.size()));
  }
  pulls = static_cast<Index>(matrix_.compliances.size());
}

void CouplingSolver::solve(const Inputs& in, std::span<Vec3d> corrections) {
  assemble(in);
  if (matrix_ != factorised_) {
    if (matrix_.pattern != factorised_.pattern) {
      factorised_.pattern.first.clear();  // of no matrix, if memory runs out
      factor_.analyse(matrix_.pattern);
    }
    factor_.factorise(matrix_);
    std::swap(matrix_, factorised_);
  }
  factor_.solve(x_);
  for (const Index p : in.active) corrections[p] = x_[row_of_[p]].head<3>();
}

std::size_t CouplingSolver::memory_bytes() const {
  std::size_t bytes = factor_.memory_bytes() + x_.capacity() * sizeof(Vec4) +
                      (rows_.capacity() + row_of_.capacity()) * sizeof(Index) + moves_.capacity() +
                      ratios_.capacity() * sizeof(double) +
                      pull_entries_.capacity() * sizeof(PullEntry);
  for (const SpringMatrix* matrix : {&matrix_, &factorised_}) {
    const SpringMatrix::Pattern& pattern = matrix->pattern;
    for (const auto* list : {&matrix->values, &matrix->grounds, &matrix->compliances})
      bytes += list->capacity() * sizeof(double);
    for (const auto* list : {&pattern.first, &pattern.columns})
      bytes += list->capacity() * sizeof(Index);
  }
  return bytes;
}

}  // namespace sunder::particles
