#pragma once

#include <sunder/core/index.h>

#include <span>
#include <vector>

namespace sunder::tear {

/// The largest mean squared errors that the fits of points may have over groups of poses.
///
/// Over no group may the sum over all points of an operation exceed that of barycentric weights. A
/// bound per point that is as strict as that costs much where a point is better than others anyway.
/// So a point may first exceed its own barycentric error by a multiple of the mean of its
/// operation; over groups where the sum is too large the multiple is reduced, and the points that
/// exceed the new bounds are fitted again. Where barycentric weights are exact, there is no slack.
class RefitBounds {
 public:
  /// @param groups      number of groups of poses.
  /// @param operations  the operation of each point; the numbers need not be consecutive.
  RefitBounds(std::size_t groups, std::span<const Index> operations);

  /// Sets the mean squared error of a point over a group with barycentric weights, square metres.
  /// @param rounding  the squared error of a stored position, posed; smaller errors do not count.
  void set_barycentric(std::size_t point, std::size_t group, double mean_square, double rounding);
  /// To be called when all are set.
  void begin();

  /// The bounds of a point, one per group; square metres.
  [[nodiscard]] std::span<const double> allowed(std::size_t point) const {
    return row(allowed_, point);
  }
  [[nodiscard]] std::span<const double> barycentric(std::size_t point) const {
    return row(barycentric_, point);
  }
  /// Whether barycentric weights are exact over some group.
  [[nodiscard]] bool is_exact(std::size_t point) const;
  /// The mean squared errors of a point's fit, one per group, which the caller fills in. At first
  /// those of barycentric weights.
  [[nodiscard]] std::span<double> of_fit(std::size_t point) {
    return std::span(of_fit_).subspan(point * groups_, groups_);
  }
  /// Reduces the slack over groups whose sum is too large.
  /// @return the points whose fits exceed the new bounds, ascending; empty: the fits can be taken.
  [[nodiscard]] std::vector<std::size_t> tighten();

 private:
  [[nodiscard]] std::span<const double> row(const std::vector<double>& of,
                                            std::size_t point) const {
    return std::span(of).subspan(point * groups_, groups_);
  }
  void allow(std::size_t operation, std::size_t group);

  std::size_t groups_;
  std::vector<std::vector<std::size_t>> points_;  ///< Per operation that has points.
  std::vector<double> barycentric_, allowed_, of_fit_, rounding_;  ///< Points x groups.
  std::vector<std::size_t> level_;  ///< Operations x groups: of the slack.
};

}  // namespace sunder::tear
