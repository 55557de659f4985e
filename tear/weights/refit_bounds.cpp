#include "tear/weights/refit_bounds.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

namespace sunder::tear {
namespace {

/// A point may exceed its barycentric mean square by these multiples of the mean of its operation,
/// one after the other.
constexpr double kSlacks[] = {0.4, 0.1, 0.0};
constexpr std::size_t kNoSlack = std::size(kSlacks) - 1;
/// The largest part of what some points gain that others may lose. Less than 1, because the gain is
/// smaller and the loss greater in poses that were not fitted.
constexpr double kMostLost = 0.1;
/// Fits whose mean squares together are below this share of the bounds of rounding are exact.
constexpr double kExact = 0.25;

}  // namespace

RefitBounds::RefitBounds(std::size_t groups, std::span<const Index> operations)
    : groups_(groups),
      barycentric_(operations.size() * groups, 0.0),
      rounding_(operations.size() * groups, 0.0),
      doubt_(operations.size() * groups, 0.0),
      mean_(operations.size() * groups, 0.0),
      level_(operations.size() * groups, 0),
      is_kept_(operations.size(), false) {
  std::map<Index, std::size_t> numbers;
  for (std::size_t point = 0; point < operations.size(); ++point) {
    const std::size_t number = numbers.try_emplace(operations[point], numbers.size()).first->second;
    if (number == points_.size()) points_.emplace_back();
    points_[number].push_back(point);
  }
}

void RefitBounds::set_barycentric(std::size_t point, std::size_t group, double mean_square,
                                  double rounding) {
  barycentric_[point * groups_ + group] = mean_square;
  rounding_[point * groups_ + group] = rounding;
}

void RefitBounds::begin() {
  of_fit_ = allowed_ = barycentric_;
  std::ranges::fill(doubt_, 0.0);
  for (const std::vector<std::size_t>& operation : points_)
    for (std::size_t group = 0; group < groups_; ++group) {
      double sum = 0;
      for (const std::size_t point : operation) sum += barycentric_[point * groups_ + group];
      for (const std::size_t point : operation) {
        mean_[point * groups_ + group] = sum / static_cast<double>(operation.size());
        allow(point, group);
      }
    }
}

bool RefitBounds::is_exact(std::size_t point) const {
  return !std::ranges::equal(barycentric(point), row(rounding_, point), std::greater<>());
}

/// Sets the bound of a point over a group.
void RefitBounds::allow(std::size_t point, std::size_t group) {
  const std::size_t at = point * groups_ + group;
  const bool is_exact = barycentric_[at] <= rounding_[at];
  allowed_[at] = is_exact ? rounding_[at] : barycentric_[at] + kSlacks[level_[at]] * mean_[at];
}

/// Reduces the slack of a point over a group until it allows less than a loss.
/// @return false if there was no slack any more, or none at all allows that loss still: it is
/// within rounding.
bool RefitBounds::lower(std::size_t point, std::size_t group, double loss) {
  const std::size_t at = point * groups_ + group;
  if (level_[at] == kNoSlack) return false;
  while (level_[at] < kNoSlack && allowed_[at] - barycentric_[at] >= loss) {
    ++level_[at];
    allow(point, group);
  }
  return allowed_[at] - barycentric_[at] < loss;
}

/// Lowers the slack of the points that lose most over a group, as many as are necessary if each of
/// them will use what it may have then, and adds them to `open`.
void RefitBounds::reduce_slack(std::vector<Loss> losing, double gained, double lost,
                               std::size_t group, std::vector<std::size_t>& open) {
  while (lost > kMostLost * gained) {
    const auto worst = std::ranges::max_element(losing, {}, &Loss::loss);
    if (worst == losing.end() || !(worst->loss > 0)) return;  // `lost` is what rounding left of it
    open.push_back(worst->point);
    lost -= worst->loss;
    const std::size_t at = worst->point * groups_ + group;
    if (lower(worst->point, group, worst->loss)) {
      worst->loss = std::max(allowed_[at] - barycentric_[at], 0.0);
    } else {
      keep(worst->point);
      worst->loss = 0;
    }
    lost += worst->loss;
  }
}

/// Lets the points that lose most keep their barycentric weights, until the others together do not
/// lose, and adds them to `open`.
void RefitBounds::keep_worst(std::span<const std::size_t> operation,
                             std::span<const double> changes, std::vector<std::size_t>& open) {
  std::vector<Loss> all;
  double sum = 0;
  for (std::size_t i = 0; i < operation.size(); ++i) {
    all.push_back({operation[i], changes[i]});
    sum += changes[i];
  }
  std::ranges::sort(all, std::greater<>(), &Loss::loss);
  for (std::size_t i = 0; i < all.size() && sum > 0 && all[i].loss > 0; ++i) {
    sum -= all[i].loss;
    keep(all[i].point);
    open.push_back(all[i].point);
  }
}

/// Adds points to `open` if an operation loses too much over a group.
void RefitBounds::tighten(std::span<const std::size_t> operation, std::size_t group,
                          const MeasureChanges& measure, std::vector<std::size_t>& open) {
  double gained = 0, lost = 0, certainly_lost = 0, doubt = 0, all = 0, rounding = 0;
  std::vector<Loss> losing;
  for (const std::size_t point : operation) {
    const std::size_t at = point * groups_ + group;
    const double loss = of_fit_[at] - barycentric_[at];
    (loss < 0 ? gained : lost) += std::abs(loss);
    certainly_lost += std::max(loss - doubt_[at], 0.0);
    doubt += doubt_[at];
    all += of_fit_[at];
    rounding += rounding_[at];
    if (loss > doubt_[at]) losing.push_back({point, loss});
  }
  if (all <= kExact * rounding) return;
  if (certainly_lost > kMostLost * gained)
    reduce_slack(std::move(losing), gained, lost, group, open);
  else if (lost + doubt > gained)
    keep_worst(operation, measure(operation, group), open);
}

std::vector<std::size_t> RefitBounds::tighten(const MeasureChanges& measure) {
  std::vector<std::size_t> open;
  for (const std::vector<std::size_t>& operation : points_)
    for (std::size_t group = 0; group < groups_; ++group) tighten(operation, group, measure, open);
  std::ranges::sort(open);
  open.erase(std::unique(open.begin(), open.end()), open.end());
  return open;
}

}  // namespace sunder::tear
