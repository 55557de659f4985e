#include "particles/motion/coupling_factor.h"

#include <algorithm>

#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

/// sums[i] += sum over k of factors[k] * columns[k * stride + i]. Four columns at a time, because
/// then a sum is loaded and stored once for four products.
void add_products(const double* columns, std::size_t stride, const double* factors,
                  std::size_t count, std::size_t length, double* sums) {
  using Pair = Eigen::Vector2d;
  const auto pair = [](const double* at) { return Eigen::Map<const Pair>(at); };
  std::size_t k = 0;
  for (; k + 4 <= count; k += 4) {
    const double *a = columns + k * stride, *b = a + stride, *c = b + stride, *d = c + stride;
    const double fa = factors[k], fb = factors[k + 1], fc = factors[k + 2], fd = factors[k + 3];
    std::size_t i = 0;
    for (; i + 2 <= length; i += 2)
      Eigen::Map<Pair>(sums + i) +=
          (fa * pair(a + i) + fb * pair(b + i)) + (fc * pair(c + i) + fd * pair(d + i));
    if (i < length) sums[i] += (fa * a[i] + fb * b[i]) + (fc * c[i] + fd * d[i]);
  }
  for (; k < count; ++k) {
    const double* a = columns + k * stride;
    const double fa = factors[k];
    std::size_t i = 0;
    for (; i + 2 <= length; i += 2) Eigen::Map<Pair>(sums + i) += fa * pair(a + i);
    if (i < length) sums[i] += fa * a[i];
  }
}

}  // namespace

void CouplingFactor::analyse(const SpringMatrix::Pattern& pattern) {
  pattern_.analyse(pattern);
  panels_.resize(pattern_.panel_entries());
  inverse_pivots_.resize(pattern_.rows());
  x_.resize(pattern_.rows());
  for (std::vector<double>* scratch : {&pivots_, &factors_, &sums_})
    scratch->resize(pattern_.tallest());
}

void CouplingFactor::factorise(const SpringMatrix& matrix) {
  std::fill(panels_.begin(), panels_.end(), 0.0);
  const auto slots = pattern_.slots();
  for (std::size_t e = 0; e < slots.size(); ++e) panels_[slots[e]] += matrix.values[e];
  const auto nodes = pattern_.nodes();
  for (const Group& group : pattern_.groups()) {
    if (group.begin == nodes.size()) {
      eliminate_pulls(matrix);
      break;
    }
    double* ground = panels_.data() + group.panel + group.height() - 1;
    for (Index place = group.begin; place < group.end; ++place, ground += group.height())
      *ground += matrix.grounds[nodes[place]];
    eliminate(group);
    update_targets(group);
  }
}

/// Turns the panel of a group of nodes, to which earlier groups have added their springs, into its
/// columns of -L.
void CouplingFactor::eliminate(const Group& group) {
  const std::size_t height = group.height(), ground = height - 1;
  double* panel = panels_.data() + group.panel;
  for (Index k = 0; k < group.pivots(); ++k) {
    double* column = panel + k * height;
    const std::size_t below = k + 1;
    for (Index j = 0; j < k; ++j) factors_[j] = panel[j * height + k] * pivots_[j];
    add_products(panel + below, height, factors_.data(), k, height - below, column + below);
    // A diagonal entry is the sum of the springs that are left.
    double sums[4] = {column[ground]};
    const std::size_t end = ground - group.pulls;
    std::size_t i = below;
    for (; i + 4 <= end; i += 4)
      for (std::size_t j = 0; j < 4; ++j) sums[j] += column[i + j];
    for (; i < end; ++i) sums[0] += column[i];
    pivots_[k] = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    const double inverse = 1 / pivots_[k];
    inverse_pivots_[group.begin + k] = inverse;
    for (i = below; i < height; ++i) column[i] *= inverse;
  }
}

/// Adds the springs that replace a group to the panels of its border's rows.
void CouplingFactor::update_targets(const Group& group) {
  const std::size_t height = group.height(), pivots = group.pivots();
  const double* below = panels_.data() + group.panel + pivots;
  for (Index t = group.first_target; t < group.target_end; ++t) {
    const FactorPattern::Target& target = pattern_.targets()[t];
    const Group& to = pattern_.groups()[target.group];
    const Index* rows = pattern_.target_rows().data() + target.rows;
    for (Index b = target.first; b < target.end; ++b, ++rows) {
      // From the diagonal, which counts for pulls alone, to the ground.
      const std::size_t length = group.border() - b + std::size_t{1};
      for (std::size_t k = 0; k < pivots; ++k) factors_[k] = below[k * height + b] * pivots_[k];
      std::fill_n(sums_.begin(), length, 0.0);
      add_products(below + b, height, factors_.data(), pivots, length, sums_.data());
      double* column = panels_.data() + to.panel + std::size_t{rows[0]} * to.height();
      for (std::size_t i = 0; i < length; ++i) column[rows[i]] += sums_[i];
    }
  }
}

/// The same for the pulls. Their panel has the compliances that they feel, which are positive; the
/// pivots are these with the opposite sign.
void CouplingFactor::eliminate_pulls(const SpringMatrix& matrix) {
  const Group& group = pattern_.groups().back();
  const std::size_t height = group.height(), pulls = group.pivots();
  double* panel = panels_.data() + group.panel;
  for (std::size_t k = 0; k < pulls; ++k) {
    double* column = panel + k * height;
    const double least = std::max(matrix.compliances[k], kLeastCompliance * column[k]);
    column[k] += least;
    for (std::size_t j = 0; j < k; ++j) factors_[j] = -panel[j * height + k] * pivots_[j];
    add_products(panel + k, height, factors_.data(), k, pulls - k, column + k);
    pivots_[k] = std::max(column[k], least);
    const double inverse = -1 / pivots_[k];
    inverse_pivots_[group.begin + k] = inverse;
    for (std::size_t i = k + 1; i < pulls; ++i) column[i] *= inverse;
  }
}

void CouplingFactor::solve(std::span<Vec4> x) {
  const auto nodes = pattern_.nodes();
  for (std::size_t place = 0; place < x_.size(); ++place)
    x_[place] = x[place < nodes.size() ? nodes[place] : place];
  reduce();
  replace_back();
  for (std::size_t place = 0; place < x_.size(); ++place)
    x[place < nodes.size() ? nodes[place] : place] = x_[place];
}

/// x_ = L^-1 x_
void CouplingFactor::reduce() {
  for (const Group& group : pattern_.groups()) {
    const std::size_t pivots = group.pivots(), height = group.height();
    const double* panel = panels_.data() + group.panel;
    Vec4* own = x_.data() + group.begin;
    for (std::size_t k = 0; k < pivots; ++k)
      for (std::size_t i = k + 1; i < pivots; ++i) own[i] += panel[k * height + i] * own[k];
    const Index* rows = pattern_.borders().data() + group.first_border;
    Index b = 0;
    for (; b + 2 <= group.border(); b += 2) {
      Vec4 sum = Vec4::Zero(), next = Vec4::Zero();
      const double* at = panel + pivots + b;
      for (std::size_t k = 0; k < pivots; ++k, at += height) {
        sum += at[0] * own[k];
        next += at[1] * own[k];
      }
      x_[rows[b]] += sum;
      x_[rows[b + 1]] += next;
    }
    if (b < group.border()) {
      Vec4 sum = Vec4::Zero();
      const double* at = panel + pivots + b;
      for (std::size_t k = 0; k < pivots; ++k, at += height) sum += at[0] * own[k];
      x_[rows[b]] += sum;
    }
  }
}

/// x_ = L^-T D^-1 x_
void CouplingFactor::replace_back() {
  for (std::size_t g = pattern_.groups().size(); g-- > 0;) {
    const Group& group = pattern_.groups()[g];
    const std::size_t pivots = group.pivots(), height = group.height();
    const double* panel = panels_.data() + group.panel;
    const double* inverse = inverse_pivots_.data() + group.begin;
    Vec4* own = x_.data() + group.begin;
    const Index* rows = pattern_.borders().data() + group.first_border;
    std::size_t k = 0;
    for (; k + 2 <= pivots; k += 2) {
      const double *a = panel + k * height + pivots, *c = a + height;
      Vec4 sum = inverse[k] * own[k], next = inverse[k + 1] * own[k + 1];
      for (Index b = 0; b < group.border(); ++b) {
        const Vec4& of = x_[rows[b]];
        sum += a[b] * of;
        next += c[b] * of;
      }
      own[k] = sum;
      own[k + 1] = next;
    }
    if (k < pivots) {
      const double* a = panel + k * height + pivots;
      Vec4 sum = inverse[k] * own[k];
      for (Index b = 0; b < group.border(); ++b) sum += a[b] * x_[rows[b]];
      own[k] = sum;
    }
    for (k = pivots; k-- > 0;) {
      Vec4 sum = own[k];
      for (std::size_t i = k + 1; i < pivots; ++i) sum += panel[k * height + i] * own[i];
      own[k] = sum;
    }
  }
}

std::size_t CouplingFactor::memory_bytes() const {
  std::size_t bytes = pattern_.memory_bytes() + x_.capacity() * sizeof(Vec4);
  for (const auto* list : {&panels_, &inverse_pivots_, &pivots_, &factors_, &sums_})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}

}  // namespace sunder::particles
