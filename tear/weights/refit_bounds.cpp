#include "tear/weights/refit_bounds.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

namespace sunder::tear {
namespace {

/// A point may exceed its barycentric mean square by these multiples of the mean of its operation,
/// in one attempt after the other.
constexpr double kSlacks[] = {0.4, 0.1, 0.0};
constexpr std::size_t kNoSlack = std::size(kSlacks) - 1;
/// The largest part of what some points gain that others may lose. Less than 1, because the gain is
/// smaller and the loss greater in poses that were not fitted.
constexpr double kMostLost = 0.1;

}  // namespace

RefitBounds::RefitBounds(std::size_t groups, std::span<const Index> operations)
    : groups_(groups),
      barycentric_(operations.size() * groups, 0.0),
      rounding_(operations.size() * groups, 0.0) {
  std::map<Index, std::size_t> numbers;
  for (std::size_t point = 0; point < operations.size(); ++point) {
    const std::size_t number = numbers.try_emplace(operations[point], numbers.size()).first->second;
    if (number == points_.size()) points_.emplace_back();
    points_[number].push_back(point);
  }
  level_.assign(points_.size() * groups, 0);
}

void RefitBounds::set_barycentric(std::size_t point, std::size_t group, double mean_square,
                                  double rounding) {
  barycentric_[point * groups_ + group] = std::max(mean_square, rounding);
  rounding_[point * groups_ + group] = rounding;
}

void RefitBounds::begin() {
  of_fit_ = allowed_ = barycentric_;
  for (std::size_t operation = 0; operation < points_.size(); ++operation)
    for (std::size_t group = 0; group < groups_; ++group) allow(operation, group);
}

bool RefitBounds::is_exact(std::size_t point) const {
  return !std::ranges::equal(barycentric(point), row(rounding_, point), std::greater<>());
}

/// Sets the bounds of an operation over a group.
void RefitBounds::allow(std::size_t operation, std::size_t group) {
  double sum = 0;
  for (const std::size_t point : points_[operation]) sum += barycentric_[point * groups_ + group];
  const double slack = kSlacks[level_[operation * groups_ + group]] * sum /
                       static_cast<double>(points_[operation].size());
  for (const std::size_t point : points_[operation]) {
    const std::size_t at = point * groups_ + group;
    allowed_[at] = barycentric_[at] + (barycentric_[at] > rounding_[at] ? slack : 0.0);
  }
}

std::vector<std::size_t> RefitBounds::tighten() {
  std::vector<std::size_t> exceeding;
  for (std::size_t operation = 0; operation < points_.size(); ++operation) {
    bool is_tighter = false;
    for (std::size_t group = 0; group < groups_; ++group) {
      double gained = 0, lost = 0;
      for (const std::size_t point : points_[operation]) {
        const double change =
            barycentric_[point * groups_ + group] - of_fit_[point * groups_ + group];
        (change > 0 ? gained : lost) += std::abs(change);
      }
      std::size_t& level = level_[operation * groups_ + group];
      if (lost <= kMostLost * gained || level == kNoSlack) continue;
      ++level;
      allow(operation, group);
      is_tighter = true;
    }
    for (const std::size_t point : points_[operation]) {
      const auto fit = of_fit(point);
      const auto most = allowed(point);
      if (is_tighter && !std::equal(fit.begin(), fit.end(), most.begin(), std::less_equal<>()))
        exceeding.push_back(point);
    }
  }
  std::sort(exceeding.begin(), exceeding.end());
  return exceeding;
}

}  // namespace sunder::tear
