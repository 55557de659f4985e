// Bounds of the blended matrix, over the skeleton as a metric tree whose lengths are angles.

#include <sunder/certificate/certificate.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "certificate/joint_path.h"

namespace sunder {
namespace certificate {
namespace {

constexpr double kSafety = 1e-10;
constexpr double kLargestStrain = 50.0;  // of the logarithm: more says nothing more
constexpr std::size_t kTaskPoints = 1024;

/// Sums of what the joints between two nodes do.
struct Way {
  double angle = 0.0;
  double strain = 0.0;
};

Way way_between(const JointTree::State& tree, std::uint32_t a, std::uint32_t b) {
  std::uint32_t meet_a = a, meet_b = b;
  while (meet_a != meet_b)
    (meet_a > meet_b ? meet_a : meet_b) = tree.nodes[std::max(meet_a, meet_b)].parent;
  Way way;
  for (std::uint32_t node : {a, b})
    for (; node != meet_a; node = tree.nodes[node].parent) {
      way.angle += tree.nodes[node].largest_turn;
      way.strain += tree.nodes[node].strain;
    }
  return way;
}

/// The share of a bone's weight that no pose within the angle takes away, as seen from a reference.
double kept(double angle, double strain) {
  return std::cos(std::min(angle, std::numbers::pi)) - std::expm1(std::min(strain, kLargestStrain));
}

/// Ways between the bones of a point; reserved once.
class BlendBound {
 public:
  explicit BlendBound(std::size_t terms) { ways_.resize(terms * terms); }

  double of(const JointTree::State& tree, std::span<const SkinTerm> terms) {
    const std::size_t n = terms.size();
    const auto node = [&](std::size_t i) { return tree.node_of_bone[terms[i].bone]; };
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      ways_[i * n + i] = {};
      for (std::size_t j = 0; j < i; ++j)
        ways_[i * n + j] = ways_[j * n + i] = way_between(tree, node(i), node(j));
      sum += terms[i].m;
    }
    double best = -1.0;
    std::size_t reference = 0;
    for (std::size_t r = 0; r < n; ++r) {
      const double value = from_place(terms, r, r, 0.0) * tree.nodes[node(r)].shrink_above;
      if (value > best) {
        best = value;
        reference = r;
      }
    }
    const double shrink = tree.nodes[node(reference)].shrink_above;
    for (std::size_t j = 0; j < n; ++j) {
      if (j == reference) continue;
      const Way& way = ways_[reference * n + j];
      const double w = terms[reference].m, v = terms[j].m;
      const double place = std::atan2(v * std::sin(way.angle), w + v * std::cos(way.angle));
      if (place <= 0 || place >= way.angle) continue;
      best =
          std::max(best, from_place(terms, reference, j, place) * shrink * std::exp(-way.strain));
    }
    return best / sum - kSafety;
  }

 private:
  /// The bound seen from a place between bones r and j, at an angle from r.
  [[nodiscard]] double from_place(std::span<const SkinTerm> terms, std::size_t r, std::size_t j,
                                  double place) const {
    const std::size_t n = terms.size();
    const Way& along = ways_[r * n + j];
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Way& way = ways_[r * n + i];
      const double fork = 0.5 * (along.angle + way.angle - ways_[i * n + j].angle);
      const double angle =
          place <= fork ? way.angle - place : way.angle + place - 2 * std::max(fork, 0.0);
      sum += terms[i].m * kept(angle, way.strain + (place > 0 ? along.strain : 0.0));
    }
    return sum;
  }

  std::vector<Way> ways_;
};

struct BlendWork {
  const JointTree::State* tree = nullptr;
  const SkinDifferences* points = nullptr;
  std::vector<double>* bounds = nullptr;
  mutable std::vector<BlendBound> scratch;

  static void run(const void* work, std::uint32_t task) {
    const auto& self = *static_cast<const BlendWork*>(work);
    const std::size_t first = task * kTaskPoints;
    const std::size_t end = std::min(first + kTaskPoints, self.bounds->size());
    for (std::size_t point = first; point < end; ++point)
      (*self.bounds)[point] = self.scratch[task].of(*self.tree, row_of(*self.points, point));
  }
};

Status check_weights(const SkinDifferences& points) {
  for (std::uint32_t point = 0; point + 1 < points.first.size(); ++point) {
    double sum = 0;
    for (const SkinTerm& term : row_of(points, point)) {
      if (term.m < 0)
        return Status::failure(StatusCode::weights_not_normalized, point,
                               "point %u: the weight of bone %u is %g", point, term.bone, term.m);
      sum += term.m;
    }
    if (!(std::abs(sum - 1) <= kSumTolerance))
      return Status::failure(StatusCode::weights_not_normalized, point,
                             "point %u: its weights sum to %g", point, sum);
  }
  return {};
}

}  // namespace
}  // namespace certificate

Result<std::vector<double>> certify_blend(const JointTree& tree, const SkinDifferences& points,
                                          const ParallelFor& parallel_for) {
  using namespace certificate;
  if (const Status status = check_rows(tree.state(), points); !status) return status;
  if (const Status status = check_weights(points); !status) return status;
  try {
    std::vector<double> bounds(points.first.size() - 1);
    std::size_t most_terms = 0;
    for (std::size_t point = 0; point < bounds.size(); ++point)
      most_terms = std::max(most_terms, row_of(points, point).size());
    const std::size_t tasks = (bounds.size() + kTaskPoints - 1) / kTaskPoints;
    const bool is_parallel = parallel_for.run != nullptr;
    BlendWork work{&tree.state(), &points, &bounds, {}};
    work.scratch.assign(tasks, BlendBound(most_terms));
    if (is_parallel)
      parallel_for.run(parallel_for.context, static_cast<std::uint32_t>(tasks), &BlendWork::run,
                       &work);
    else
      for (std::uint32_t task = 0; task < tasks; ++task) BlendWork::run(&work, task);
    return bounds;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

}  // namespace sunder
