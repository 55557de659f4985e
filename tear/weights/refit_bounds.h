#pragma once

#include <sunder/core/index.h>

#include <functional>
#include <span>
#include <vector>

namespace sunder::tear {

/// The largest mean squared errors that the fits of points may have over groups of poses.
///
/// Over no group may the sum over all points of an operation exceed that of barycentric weights. A
/// bound per point that is as strict as that costs much where a point is better than others anyway.
/// So a point may first exceed its own barycentric error by a multiple of the mean of its
/// operation. Over groups where the points together lose too much, those that lose most get less,
/// as many as necessary, and are fitted again. A point that has no slack left, and loses within
/// rounding only, keeps its barycentric weights. docs/method/weights.md shows that this ends, and
/// that no group is worse then.
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
  [[nodiscard]] std::span<const double> rounding(std::size_t point) const {
    return row(rounding_, point);
  }
  /// Whether barycentric weights are exact over some group.
  [[nodiscard]] bool is_exact(std::size_t point) const;
  /// Lets a point keep its barycentric weights for good; its next fit has to be those.
  void keep(std::size_t point) { is_kept_[point] = true; }
  [[nodiscard]] bool is_kept(std::size_t point) const { return is_kept_[point]; }
  /// The mean squared errors of a point's fit, one per group, which the caller fills in. At first
  /// those of barycentric weights.
  [[nodiscard]] std::span<double> of_fit(std::size_t point) {
    return std::span(of_fit_).subspan(point * groups_, groups_);
  }
  /// By how much the change from barycentric weights can differ from that between of_fit() and
  /// barycentric(), one per group. At first 0, as for a point that has barycentric weights.
  [[nodiscard]] std::span<double> doubt(std::size_t point) {
    return std::span(doubt_).subspan(point * groups_, groups_);
  }
  /// The change of the mean squared error of each of some points over a group, as the stored
  /// weights pose them: that of the fit less that of barycentric weights.
  using MeasureChanges =
      std::function<std::vector<double>(std::span<const std::size_t> points, std::size_t group)>;
  /// Reduces the slack of points over groups in which their operation loses too much. Where
  /// doubt() decides whether it loses, `measure` does.
  /// @return the points to fit again, because they exceed the new bounds or are kept, ascending;
  /// empty: over no group is an operation worse than with barycentric weights.
  [[nodiscard]] std::vector<std::size_t> tighten(const MeasureChanges& measure);

 private:
  [[nodiscard]] std::span<const double> row(const std::vector<double>& of,
                                            std::size_t point) const {
    return std::span(of).subspan(point * groups_, groups_);
  }
  struct Loss {
    std::size_t point;
    double loss;
  };
  void tighten(std::span<const std::size_t> operation, std::size_t group,
               const MeasureChanges& measure, std::vector<std::size_t>& open);
  void reduce_slack(std::vector<Loss> losing, double gained, double lost, std::size_t group,
                    std::vector<std::size_t>& open);
  void keep_worst(std::span<const std::size_t> operation, std::span<const double> changes,
                  std::vector<std::size_t>& open);
  [[nodiscard]] bool lower(std::size_t point, std::size_t group, double loss);
  void allow(std::size_t point, std::size_t group);

  std::size_t groups_;
  std::vector<std::vector<std::size_t>> points_;  ///< Per operation that has points.
  std::vector<double> barycentric_, allowed_, of_fit_, rounding_;  ///< Points x groups.
  std::vector<double> doubt_;                                      ///< Likewise.
  std::vector<double> mean_;        ///< Likewise: of barycentric_ over the point's operation.
  std::vector<std::size_t> level_;  ///< Likewise: of the slack.
  std::vector<bool> is_kept_;       ///< Per point.
};

}  // namespace sunder::tear
