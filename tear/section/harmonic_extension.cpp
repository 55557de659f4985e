#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/internal/ordered.h"
#include "tear/section/flat_section.h"

namespace sunder::tear {
namespace {

/// The weight of an edge in the cotangent Laplacian, with the inner point that it belongs to.
struct EdgeWeight {
  Index neighbour = kNone;  ///< Any point.
  double value = 0;
};

/// The rows of the cotangent Laplacian, one per inner point.
class Laplacian {
 public:
  Laplacian(std::span<const Vec2d> points, Index rim_count, const FlatMesh& mesh,
            std::pmr::memory_resource& memory)
      : rim_count_(rim_count), first_(mesh.inner.size() + 1, 0, &memory), weights_(&memory) {
    // An inner point has as many neighbours as triangles.
    for (const auto& triangle : mesh.triangles)
      for (const Index p : triangle)
        if (p >= rim_count) ++first_[p - rim_count + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    weights_.resize(first_.back());
    for (const auto& triangle : mesh.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const Index a = triangle[i], b = triangle[(i + 1) % 3];
        if (a < rim_count && b < rim_count) continue;
        const Vec2d to_a = points[a] - points[triangle[(i + 2) % 3]],
                    to_b = points[b] - points[triangle[(i + 2) % 3]];
        const double twice_area = to_a.x() * to_b.y() - to_a.y() * to_b.x();
        const double cotangent = twice_area > 0 ? dot(to_a, to_b) / twice_area : 0.0;
        add(a, b, cotangent);
        add(b, a, cotangent);
      }
    for (EdgeWeight& weight : weights_)  // Zero but for rounding: four points lie on a circle.
      if (!(weight.value > 0) || !std::isfinite(weight.value)) weight.value = 0;
  }

  [[nodiscard]] std::span<const EdgeWeight> of(Index inner) const {
    return std::span(weights_).subspan(first_[inner], first_[inner + 1] - first_[inner]);
  }

 private:
  void add(Index point, Index neighbour, double cotangent) {
    if (point < rim_count_) return;
    EdgeWeight* weight = &weights_[first_[point - rim_count_]];
    while (weight->neighbour != neighbour && weight->neighbour != kNone) ++weight;
    weight->neighbour = neighbour;
    weight->value += cotangent;
  }

  Index rim_count_;
  std::pmr::vector<Index> first_;  ///< Per inner point its first weight, then the number of all.
  std::pmr::vector<EdgeWeight> weights_;
};

/// An order of elimination in which few entries fill in: nested dissection. The points are halved
/// across their longer extent; those on the border between the halves are eliminated last.
class Dissection {
 public:
  Dissection(std::span<const Vec2d> points, const Laplacian& laplacian, Index rim_count,
             std::pmr::memory_resource& memory)
      : points_(points),
        laplacian_(laplacian),
        rim_count_(rim_count),
        order_(points.size() - rim_count, 0, &memory),
        half_(order_.size(), 0, &memory) {
    std::iota(order_.begin(), order_.end(), Index{0});
    divide(order_);
  }

  /// Inner points; the first are eliminated last.
  [[nodiscard]] std::span<const Index> order() const { return order_; }

 private:
  static constexpr std::size_t kUndivided = 12;

  void divide(std::span<Index> part) {
    while (part.size() > kUndivided) {
      const std::size_t axis = longer_axis(part);
      const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
      const auto is_lower = [&](Index a, Index b) {
        const double at_a = points_[rim_count_ + a][static_cast<Eigen::Index>(axis)],
                     at_b = points_[rim_count_ + b][static_cast<Eigen::Index>(axis)];
        return at_a != at_b ? at_a < at_b : a < b;
      };
      std::nth_element(part.begin(), middle, part.end(), is_lower);
      ++upper_half_;
      for (auto upper = middle; upper != part.end(); ++upper) half_[*upper] = upper_half_;
      const auto border = std::partition(part.begin(), middle, [&](Index v) {
        return std::ranges::any_of(laplacian_.of(v), [&](const EdgeWeight& weight) {
          return weight.neighbour >= rim_count_ &&
                 half_[weight.neighbour - rim_count_] == upper_half_;
        });
      });
      // The order within a part does not depend on the standard library.
      std::sort(part.begin(), border);
      divide({border, middle});
      part = {middle, part.end()};
    }
    std::sort(part.begin(), part.end());
  }

  [[nodiscard]] std::size_t longer_axis(std::span<const Index> part) const {
    Vec2d low = points_[rim_count_ + part[0]], high = low;
    for (const Index v : part) {
      low = low.cwiseMin(points_[rim_count_ + v]);
      high = high.cwiseMax(points_[rim_count_ + v]);
    }
    return high.x() - low.x() >= high.y() - low.y() ? 0 : 1;
  }

  std::span<const Vec2d> points_;
  const Laplacian& laplacian_;
  Index rim_count_;
  std::pmr::vector<Index> order_;
  std::pmr::vector<Index> half_;  ///< Per inner point the last upper half that it was in.
  Index upper_half_ = 0;
};

/// The factors L D L^T of the Laplacian between inner points, which are numbered by an order of
/// elimination and eliminated from the last to the first.
class Factors {
 public:
  Factors(const Laplacian& laplacian, Index rim_count, std::span<const Index> order,
          std::pmr::memory_resource& memory)
      : order_(order),
        rank_(order.size(), 0, &memory),
        first_(order.size() + 1, 0, &memory),
        entries_(&memory),
        pivots_(order.size(), 0.0, &memory) {
    for (Index v = 0; v < order.size(); ++v) rank_[order[v]] = v;
    find_entries(laplacian, rim_count, memory);
    enter(laplacian, rim_count);
    eliminate();
  }

  /// Solves for one row of `channels` values per inner point.
  void solve(std::size_t channels, std::span<double> rows) const {
    const auto count = static_cast<Index>(pivots_.size());
    const auto row = [&](Index v) { return rows.data() + order_[v] * channels; };
    for (Index v = count; v-- > 0;)
      for (const Entry& entry : column(v)) subtract(entry.value, row(v), channels, row(entry.v));
    for (Index v = 0; v < count; ++v) {
      for (std::size_t c = 0; c < channels; ++c) row(v)[c] /= pivots_[v];
      for (const Entry& entry : column(v)) subtract(entry.value, row(entry.v), channels, row(v));
    }
  }

 private:
  struct Entry {
    Index v;  ///< Before that of its column.
    double value = 0;
  };

  static void subtract(double factor, const double* from, std::size_t channels, double* row) {
    for (std::size_t c = 0; c < channels; ++c) row[c] -= factor * from[c];
  }

  /// The entries of a point, descending. Columns are stored from the last to the first.
  [[nodiscard]] std::span<const Entry> column(Index v) const {
    return std::span(entries_).subspan(first_[v + 1], first_[v] - first_[v + 1]);
  }
  [[nodiscard]] std::span<Entry> column(Index v) {
    return std::span(entries_).subspan(first_[v + 1], first_[v] - first_[v + 1]);
  }

  /// Finds the neighbours of each point when it is eliminated: those of the Laplacian, and those of
  /// the points that were eliminated before and of which it was the next neighbour.
  void find_entries(const Laplacian& laplacian, Index rim_count,
                    std::pmr::memory_resource& memory) {
    const auto count = static_cast<Index>(pivots_.size());
    std::pmr::vector<Index> newest_child(count, kNone, &memory), older_child(count, kNone, &memory),
        seen_by(count, kNone, &memory);
    entries_.reserve(std::size_t{12} * count);
    for (Index v = count; v-- > 0;) {
      const std::size_t begin = entries_.size();
      const auto add = [&](Index u) {
        if (u >= v || seen_by[u] == v) return;
        seen_by[u] = v;
        entries_.push_back({u});
      };
      for (const EdgeWeight& weight : laplacian.of(order_[v]))
        if (weight.neighbour >= rim_count) add(rank_[weight.neighbour - rim_count]);
      for (Index child = newest_child[v]; child != kNone; child = older_child[child])
        for (std::size_t i = first_[child + 1]; i < first_[child]; ++i) add(entries_[i].v);
      std::sort(entries_.begin() + static_cast<std::ptrdiff_t>(begin), entries_.end(),
                [](const Entry& a, const Entry& b) { return a.v > b.v; });
      first_[v] = static_cast<Index>(entries_.size());
      if (entries_.size() == begin) continue;
      const Index parent = entries_[begin].v;
      older_child[v] = newest_child[parent];
      newest_child[parent] = v;
    }
  }

  void enter(const Laplacian& laplacian, Index rim_count) {
    for (Index v = 0; v < pivots_.size(); ++v)
      for (const EdgeWeight& weight : laplacian.of(order_[v])) {
        pivots_[v] += weight.value;
        if (weight.neighbour < rim_count || rank_[weight.neighbour - rim_count] >= v) continue;
        std::ranges::find(column(v), rank_[weight.neighbour - rim_count], &Entry::v)->value =
            -weight.value;
      }
  }

  void eliminate() {
    for (Index v = static_cast<Index>(pivots_.size()); v-- > 0;) {
      if (!(pivots_[v] > 0)) pivots_[v] = 1;  // a point without weights, which then gets zeros
      const std::span<Entry> of_v = column(v);
      for (std::size_t i = 0; i < of_v.size(); ++i) {
        const double factor = of_v[i].value / pivots_[v];
        pivots_[of_v[i].v] -= factor * of_v[i].value;
        Entry* target = column(of_v[i].v).data();
        for (std::size_t k = i + 1; k < of_v.size(); ++k) {
          while (target->v != of_v[k].v) ++target;
          target->value -= factor * of_v[k].value;
        }
      }
      for (Entry& entry : of_v) entry.value /= pivots_[v];
    }
  }

  std::span<const Index> order_;  ///< The inner point of each number.
  std::pmr::vector<Index> rank_;  ///< The number of each inner point.
  /// Where the column before that of a point ends, from the last point to the first: first_[v + 1]
  /// is the begin of column v.
  std::pmr::vector<Index> first_;
  std::pmr::vector<Entry> entries_;
  std::pmr::vector<double> pivots_;
};

}  // namespace

void extend_harmonically(std::span<const Vec2d> points, const FlatMesh& mesh, std::size_t channels,
                         std::span<double> values, std::pmr::memory_resource& memory) {
  const auto inner_count = static_cast<Index>(mesh.inner.size());
  const auto rim_count = static_cast<Index>(points.size() - inner_count);
  if (inner_count == 0 || rim_count == 0) return;
  const Laplacian laplacian(points, rim_count, mesh, memory);
  std::pmr::vector<double> least(channels, 0.0, &memory), greatest(channels, 0.0, &memory);
  for (std::size_t c = 0; c < channels; ++c) {
    least[c] = greatest[c] = values[c];
    for (std::size_t i = c; i < rim_count * channels; i += channels) {
      least[c] = std::min(least[c], values[i]);
      greatest[c] = std::max(greatest[c], values[i]);
    }
  }
  const std::span<double> rows = values.subspan(rim_count * channels);
  std::fill(rows.begin(), rows.end(), 0.0);
  for (Index v = 0; v < inner_count; ++v)
    for (const EdgeWeight& weight : laplacian.of(v))
      for (std::size_t c = 0; c < channels && weight.neighbour < rim_count; ++c)
        // Relative to the least value, because a common offset would only cost precision.
        rows[v * channels + c] +=
            weight.value * (values[weight.neighbour * channels + c] - least[c]);
  const Dissection dissection(points, laplacian, rim_count, memory);
  Factors(laplacian, rim_count, dissection.order(), memory).solve(channels, rows);
  for (Index v = 0; v < inner_count; ++v)
    for (std::size_t c = 0; c < channels; ++c) {
      double& value = rows[v * channels + c];
      value = std::clamp(std::isfinite(value) ? least[c] + value : least[c], least[c], greatest[c]);
    }
}

}  // namespace sunder::tear
