#include <sunder/certificate/certificate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "weights/certificate/point_bound.h"

namespace sunder {
namespace certificate {
namespace {

constexpr std::size_t kLeastPerTask = 256;
constexpr std::uint64_t kMostRefined = 8;  // times what is asked for

/// Points [first, end) of one task, and its memory.
struct BoundTask {
  std::size_t first = 0, end = 0;
  PointBound bound_of;
  std::vector<SlideResidual> residuals = {};
};

/// Keeps the largest weight of each bone, ascending by bone; of equal ones the first point.
void add_residual(const SlideResidual& residual, std::vector<SlideResidual>& residuals) {
  const auto at = std::ranges::lower_bound(residuals, residual.bone, {}, &SlideResidual::bone);
  if (at == residuals.end() || at->bone != residual.bone)
    residuals.insert(at, residual);
  else if (residual.weight > at->weight)
    *at = residual;
}

struct BoundWork {
  const SkinDifferences* rows = nullptr;
  double rounding = 0;
  std::vector<double>* bound = nullptr;
  mutable std::vector<BoundTask> tasks;

  static void run(const void* work, std::uint32_t index) {
    const auto& self = *static_cast<const BoundWork*>(work);
    BoundTask& task = self.tasks[index];
    for (std::size_t point = task.first; point < task.end; ++point) {
      const auto terms = row_of(*self.rows, point);
      double& bound = (*self.bound)[point];
      bound = terms.empty() ? 0.0 : task.bound_of.of(terms) + self.rounding;
      if (terms.empty() || !std::isfinite(bound)) continue;
      for (SlideResidual residual : task.bound_of.crossed()) {
        residual.point = static_cast<std::uint32_t>(point);
        add_residual(residual, task.residuals);
      }
    }
  }
};

void run_tasks(const JointTree::State& tree, BoundWork& work, const ParallelFor& parallel_for) {
  const std::size_t points = work.bound->size();
  const std::size_t wanted =
      parallel_for.run == nullptr ? 1 : std::size_t{4} * std::max(parallel_for.threads, 1u);
  const std::size_t count = std::clamp<std::size_t>(points / kLeastPerTask, 1, wanted);
  std::size_t most_terms = 0;
  for (std::size_t point = 0; point < points; ++point)
    most_terms = std::max(most_terms, row_of(*work.rows, point).size());
  for (std::size_t i = 0; i < count; ++i)
    work.tasks.push_back({points * i / count, points * (i + 1) / count,
                          PointBound(tree, most_terms, kSumTolerance)});
  if (count == 1) return BoundWork::run(&work, 0);
  parallel_for.run(parallel_for.context, static_cast<std::uint32_t>(count), &BoundWork::run, &work);
}

void add_gap(const PathGap& gap, std::uint32_t point, std::vector<CertificateGap>& gaps) {
  for (CertificateGap& known : gaps)
    if (known.reason == gap.reason && known.bone == gap.bone) {
      ++known.count;
      return;
    }
  gaps.push_back({gap.reason, gap.bone, point, 1});
}

/// Refines the worst points, and more of them while the largest bound is not refined.
void refine_worst(const JointTree::State& tree, const BoundWork& work, std::uint32_t wanted,
                  std::vector<double>& bound) {
  using Entry = std::pair<double, std::uint32_t>;
  const auto comes_later = [](const Entry& a, const Entry& b) {
    return a.first != b.first ? a.first < b.first : a.second > b.second;
  };
  std::vector<Entry> heap;
  for (std::uint32_t point = 0; point < bound.size(); ++point)
    if (bound[point] > 0 && bound[point] < std::numeric_limits<double>::infinity())
      heap.emplace_back(bound[point], point);
  std::make_heap(heap.begin(), heap.end(), comes_later);
  double largest = 0;
  for (std::uint64_t i = 0; !heap.empty() && i < kMostRefined * wanted; ++i) {
    if (i >= wanted && heap.front().first <= largest) break;
    std::pop_heap(heap.begin(), heap.end(), comes_later);
    const std::uint32_t point = heap.back().second;
    heap.pop_back();
    const double refined = refined_bound(tree, row_of(*work.rows, point)) + work.rounding;
    bound[point] = std::min(bound[point], refined);
    largest = std::max(largest, bound[point]);
  }
}

void summarise(const JointTree::State& tree, const SkinDifferences& rows, const BoundWork& work,
               DeviationCertificate& certificate) {
  for (const BoundTask& task : work.tasks)
    for (const SlideResidual& residual : task.residuals)
      add_residual(residual, certificate.slide_residuals);
  certificate.sum_residual = rows.divided_sum;
  for (std::uint32_t point = 0; point < certificate.bound.size(); ++point) {
    const auto terms = row_of(rows, point);
    const double bound = certificate.bound[point];
    PathGap gap;
    if (bound == std::numeric_limits<double>::infinity() && find_gap(tree, terms, gap)) {
      add_gap(gap, point, certificate.gaps);
      continue;
    }
    if (bound > certificate.maximum) {
      certificate.maximum = bound;
      certificate.worst = point;
    }
    double sum = 0;
    for (const SkinTerm& term : terms) sum += term.m;
    certificate.sum_residual = std::max(certificate.sum_residual, std::abs(sum));
  }
}

}  // namespace
}  // namespace certificate

Result<DeviationCertificate> certify_deviation(const JointTree& tree,
                                               const SkinDifferences& differences,
                                               const CertificateOptions& options,
                                               const ParallelFor& parallel_for) {
  using namespace certificate;
  if (const Status status = check_rows(tree.state(), differences); !status) return status;
  if (!(options.rounding >= 0) || !std::isfinite(options.rounding))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "rounding is %g m; it must be finite and not negative",
                           options.rounding);
  try {
    DeviationCertificate certificate;
    certificate.bound.resize(differences.first.size() - 1);
    BoundWork work{&differences, options.rounding, &certificate.bound, {}};
    run_tasks(tree.state(), work, parallel_for);
    refine_worst(tree.state(), work, options.refined_points, certificate.bound);
    summarise(tree.state(), differences, work, certificate);
    return certificate;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

std::vector<std::uint32_t> worst_points(const DeviationCertificate& certificate,
                                        std::size_t count) try {
  const std::vector<double>& bound = certificate.bound;
  std::vector<std::uint32_t> points;
  for (std::uint32_t point = 0; point < bound.size(); ++point)
    if (bound[point] > 0 && std::isfinite(bound[point])) points.push_back(point);
  const auto middle = points.begin() + static_cast<std::ptrdiff_t>(std::min(count, points.size()));
  std::partial_sort(points.begin(), middle, points.end(), [&](std::uint32_t a, std::uint32_t b) {
    return bound[a] != bound[b] ? bound[a] > bound[b] : a < b;
  });
  points.erase(middle, points.end());
  return points;
} catch (const std::bad_alloc&) {
  return {};
}

}  // namespace sunder
