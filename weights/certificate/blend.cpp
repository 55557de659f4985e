// Bounds of the blended matrix, over the skeleton as a metric tree whose lengths are angles.

#include <sunder/certificate/certificate.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "core/internal/ordered.h"
#include "weights/certificate/blend_matrices.h"
#include "weights/certificate/joint_path.h"
#include "weights/certificate/polar.h"

namespace sunder {
namespace certificate {
namespace {

constexpr double kSafety = 1e-10;
constexpr double kLargestStrain = 50.0;  // of the logarithm: more says nothing more
constexpr std::size_t kTaskPoints = 1024;

/// The share of a bone's weight that no pose within the angle takes away, as seen from a reference.
double kept(double angle, double strain) {
  return std::cos(std::min(angle, std::numbers::pi)) - std::expm1(std::min(strain, kLargestStrain));
}

/// Angle of the rotation between two others.
double angle_between(const Mat3d& a, const Mat3d& b) {
  const Mat3d turn = multiply(a, Mat3d(b.transpose()));
  const Vec3d twice_sine(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
  return std::atan2(norm(twice_sine), trace(turn) - 1.0);
}

/// Ways between the bones of a point; reserved once. The matrix that a skin has at bind is one more
/// joint below the bone, which does not move.
class BlendBound {
 public:
  explicit BlendBound(std::size_t terms) {
    ways_.resize(terms * terms);
    ends_.resize(terms);
  }

  double of(const JointTree::State& tree, std::span<const SkinTerm> terms,
            std::span<const Mat3d> at_bind) {
    if (!relative_to_bind(terms, at_bind, relative_)) return -1.0;
    const std::size_t n = terms.size();
    const auto node = [&](std::size_t i) { return tree.node_of_bone[terms[i].bone]; };
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      ways_[i * n + i] = ends_[i] = {};
      for (std::size_t j = 0; j < i; ++j)
        ways_[i * n + j] = ways_[j * n + i] = way_between(tree, node(i), node(j));
      sum += terms[i].m;
    }
    split_matrices();
    double best = -1.0;
    std::size_t reference = 0;
    for (std::size_t r = 0; r < n; ++r) {
      turn_ends_from(r);
      const double value = from_place(terms, r, r, 0.0) * tree.nodes[node(r)].shrink_above;
      if (value > best) {
        best = value;
        reference = r;
      }
    }
    turn_ends_from(reference);
    const double shrink = tree.nodes[node(reference)].shrink_above;
    for (std::size_t j = 0; j < n; ++j) {
      if (j == reference) continue;
      const Way way = way_to_end(reference * n + j, j);
      const double w = terms[reference].m, v = terms[j].m;
      const double place = std::atan2(v * std::sin(way.angle), w + v * std::cos(way.angle));
      if (place <= 0 || place >= way.angle) continue;
      best =
          std::max(best, from_place(terms, reference, j, place) * shrink * std::exp(-way.strain));
    }
    return best / sum - kSafety;
  }

 private:
  /// Rotations and strains of the matrices at bind.
  void split_matrices() {
    for (std::size_t i = 0; i < relative_.size(); ++i) {
      const Polar parts = polar(relative_[i]);
      ends_[i].strain = std::log1p(std::max(parts.largest - 1.0, 1.0 - parts.least));
      relative_[i] = parts.rotation;
    }
  }

  /// Angles of the matrices at bind, seen from that of a reference.
  void turn_ends_from(std::size_t reference) {
    for (std::size_t i = 0; i < relative_.size(); ++i)
      ends_[i].angle = angle_between(relative_[i], relative_[reference]);
  }

  /// A way with its end below a bone.
  [[nodiscard]] Way way_to_end(std::size_t way, std::size_t bone) const {
    return {ways_[way].angle + ends_[bone].angle, ways_[way].strain + ends_[bone].strain};
  }

  /// The bound seen from a place between bones r and j, at an angle from r.
  [[nodiscard]] double from_place(std::span<const SkinTerm> terms, std::size_t r, std::size_t j,
                                  double place) const {
    const std::size_t n = terms.size();
    const Way along = way_to_end(r * n + j, j);
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Way way = way_to_end(r * n + i, i);
      const double across = i == j ? 0.0 : ways_[i * n + j].angle + ends_[i].angle + ends_[j].angle;
      const double fork = 0.5 * (along.angle + way.angle - across);
      const double angle =
          place <= fork ? way.angle - place : way.angle + place - 2 * std::max(fork, 0.0);
      sum += terms[i].m * kept(angle, way.strain + (place > 0 ? along.strain : 0.0));
    }
    return sum;
  }

  std::vector<Way> ways_;
  std::vector<Way> ends_;        // per term: its matrix at bind
  std::vector<Mat3d> relative_;  // the same, as rotations
};

struct BlendWork {
  const JointTree::State* tree = nullptr;
  const SkinBlends* blends = nullptr;
  std::vector<double>* bounds = nullptr;
  mutable std::vector<BlendBound> scratch;

  static void run(const void* work, std::uint32_t task) {
    const auto& self = *static_cast<const BlendWork*>(work);
    const std::size_t first = task * kTaskPoints;
    const std::size_t end = std::min(first + kTaskPoints, self.bounds->size());
    for (std::size_t point = first; point < end; ++point)
      (*self.bounds)[point] = self.scratch[task].of(*self.tree, row_of(self.blends->points, point),
                                                    at_bind_of(*self.blends, point));
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

Result<std::vector<double>> certify_blend(const JointTree& tree, const SkinBlends& blends,
                                          const ParallelFor& parallel_for) {
  using namespace certificate;
  const SkinDifferences& points = blends.points;
  if (const Status status = check_blends(tree.state(), blends); !status) return status;
  if (const Status status = check_weights(points); !status) return status;
  try {
    std::vector<double> bounds(points.first.size() - 1);
    std::size_t most_terms = 0;
    for (std::size_t point = 0; point < bounds.size(); ++point)
      most_terms = std::max(most_terms, row_of(points, point).size());
    const std::size_t tasks = (bounds.size() + kTaskPoints - 1) / kTaskPoints;
    const bool is_parallel = parallel_for.run != nullptr;
    BlendWork work{&tree.state(), &blends, &bounds, {}};
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
