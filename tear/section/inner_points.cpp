#include "tear/section/inner_points.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/internal/ordered.h"

namespace sunder::tear {
namespace {

constexpr double kRowHeight = 0.86602540378443865;  // sqrt(3) / 2 of the spacing

/// Rows of points; every other row is shifted by half a spacing.
struct Lattice {
  Vec2d origin;
  double spacing;

  [[nodiscard]] double y(long row) const {
    return origin.y() + static_cast<double>(row) * (kRowHeight * spacing);
  }
  [[nodiscard]] double row_start(long row) const {
    return origin.x() + (row % 2 != 0 ? 0.5 * spacing : 0.0);
  }
  [[nodiscard]] Vec2d point(long row, long column) const {
    return {row_start(row) + static_cast<double>(column) * spacing, y(row)};
  }
  [[nodiscard]] long first_row_above(double height) const {
    return static_cast<long>(std::ceil((height - origin.y()) / (kRowHeight * spacing)));
  }
  [[nodiscard]] long first_column_after(long row, double x) const {
    return static_cast<long>(std::ceil((x - row_start(row)) / spacing));
  }
};

/// Points of one row between two edges.
struct Run {
  long row, first, last;  ///< Columns [first, last).
  std::size_t offset;     ///< Index of the first among all points.
};

/// The runs inside the polygons, ordered by row and column. Empty if there would be more than
/// `capacity` points, which sets `is_too_many`.
std::vector<Run> find_runs(const Lattice& lattice, std::span<const Vec2d> points,
                           std::span<const std::array<Index, 2>> edges, std::size_t capacity,
                           bool& is_too_many) {
  std::vector<std::pair<long, double>> crossings;
  for (const auto& edge : edges) {
    const Vec2d& a = points[edge[0]];
    const Vec2d& b = points[edge[1]];
    const long first = lattice.first_row_above(std::min(a.y(), b.y())) - 1;
    const long last = lattice.first_row_above(std::max(a.y(), b.y())) + 1;
    for (long row = first; row <= last; ++row) {
      const double y = lattice.y(row);
      if ((a.y() <= y) != (b.y() <= y))
        crossings.emplace_back(row, a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
  }
  std::sort(crossings.begin(), crossings.end());
  std::vector<Run> runs;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 1 < crossings.size();
       i += 2) {  // an even number in each row: the polygons are closed
    const long row = crossings[i].first;
    const long first = lattice.first_column_after(row, crossings[i].second);
    const long last = lattice.first_column_after(row, crossings[i + 1].second);
    if (last <= first) continue;
    runs.push_back({row, first, last, count});
    count += static_cast<std::size_t>(last - first);
  }
  is_too_many = count > 2 * capacity + crossings.size();  // those near the edges will be removed
  if (is_too_many) runs.clear();
  return runs;
}

/// Removes the points that are closer to an edge than `distance`.
void clear_near(const Vec2d& a, const Vec2d& b, double distance, const Lattice& lattice,
                std::span<const Run> runs, std::vector<char>& keep) {
  const Vec2d along = b - a;
  const double squared_length = squared_norm(along);
  const long end_row = lattice.first_row_above(std::max(a.y(), b.y()) + distance) + 1;
  for (long row = lattice.first_row_above(std::min(a.y(), b.y()) - distance) - 1; row < end_row;
       ++row) {
    // The part of the edge whose height is within the distance of the row; all of it if it is
    // nearly horizontal.
    double from = 0, to = 1;
    if (std::abs(along.y()) > distance) {
      from = (lattice.y(row) - 1.01 * distance - a.y()) / along.y();
      to = (lattice.y(row) + 1.01 * distance - a.y()) / along.y();
      if (from > to) std::swap(from, to);
      from = std::clamp(from, 0.0, 1.0);
      to = std::clamp(to, 0.0, 1.0);
    }
    const double x0 = a.x() + from * along.x(), x1 = a.x() + to * along.x();
    const long first = lattice.first_column_after(row, std::min(x0, x1) - distance) - 1;
    const long last = lattice.first_column_after(row, std::max(x0, x1) + distance) + 1;
    auto run = std::partition_point(runs.begin(), runs.end(), [&](const Run& r) {
      return r.row != row ? r.row < row : r.last <= first;
    });
    for (; run != runs.end() && run->row == row && run->first < last; ++run)
      for (long column = std::max(first, run->first); column < std::min(last, run->last);
           ++column) {
        const Vec2d offset = lattice.point(row, column) - a;
        const double t =
            squared_length > 0 ? std::clamp(dot(offset, along) / squared_length, 0.0, 1.0) : 0.0;
        if (squared_norm(offset - t * along) < distance * distance)
          keep[run->offset + static_cast<std::size_t>(column - run->first)] = 0;
      }
  }
}

}  // namespace

std::vector<Vec2d> place_inner_points(std::span<const Vec2d> points,
                                      std::span<const std::array<Index, 2>> edges, double area,
                                      double spacing, std::size_t capacity) {
  if (edges.empty()) return {};
  Vec2d low = points[edges[0][0]], high = low;
  double perimeter = 0;
  for (const auto& edge : edges) {
    low = low.cwiseMin(points[edge[0]]);
    high = high.cwiseMax(points[edge[0]]);
    perimeter += norm(points[edge[1]] - points[edge[0]]);
  }
  // Maximum number of rows along all edges, for any spacing: it bounds the time for a region that
  // is all rim.
  spacing = std::max(spacing, perimeter / (64.0 * static_cast<double>(edges.size() + 64)));
  spacing =
      std::max(spacing, std::sqrt(std::abs(area) / (kRowHeight * static_cast<double>(capacity))));
  for (;; spacing *= 1.25) {
    const Lattice lattice{0.5 * (low + high), spacing};
    bool is_too_many = false;
    const std::vector<Run> runs = find_runs(lattice, points, edges, capacity, is_too_many);
    if (is_too_many) continue;
    if (runs.empty()) return {};
    std::vector<char> keep(
        runs.back().offset + static_cast<std::size_t>(runs.back().last - runs.back().first), 1);
    for (const auto& edge : edges)
      clear_near(points[edge[0]], points[edge[1]], 0.5 * spacing, lattice, runs, keep);
    if (std::count(keep.begin(), keep.end(), char{1}) > static_cast<std::ptrdiff_t>(capacity))
      continue;
    std::vector<Vec2d> inner;
    for (const Run& run : runs)
      for (long column = run.first; column < run.last; ++column)
        if (keep[run.offset + static_cast<std::size_t>(column - run.first)] != 0)
          inner.push_back(lattice.point(run.row, column));
    return inner;
  }
}

}  // namespace sunder::tear
