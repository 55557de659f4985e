#include "pipeline/binding/heat.h"

#include <algorithm>
#include <limits>

#include <Eigen/SparseCholesky>

#include "core/internal/ordered.h"
#include "pipeline/binding/sight.h"
#include "pipeline/binding/stiffness.h"

namespace sunder::binding {
namespace {

constexpr double kSameDistance = 1e-4;   ///< Relative: bones that are equally near.
constexpr double kLeastDistance = 1e-4;  ///< Of the diagonal.
constexpr double kLeastWeight = 1e-6;    ///< Smaller shares are those of rounding.

/// The bones that are nearest to a point, and the place of each that is nearest.
struct Nearest {
  double distance = 0;
  std::vector<Index> bones;  ///< Ascending.
  std::vector<Vec3d> places;
  bool is_seen = false;  ///< The bones then are those that are seen.
};

Vec3d nearest_place(const BoneSegment& segment, const Vec3d& point) {
  const Vec3d along = segment.end - segment.begin;
  const double square = squared_norm(along);
  if (!(square > 0)) return segment.begin;
  const double t = std::clamp(dot(along, Vec3d(point - segment.begin)) / square, 0.0, 1.0);
  return segment.begin + t * along;
}

Nearest find_nearest(std::span<const BoneSegment> segments, const Vec3d& point) {
  std::vector<Vec3d> places;
  std::vector<double> distances;
  Nearest nearest;
  nearest.distance = std::numeric_limits<double>::infinity();
  for (const BoneSegment& segment : segments) {
    places.push_back(nearest_place(segment, point));
    distances.push_back(norm(Vec3d(places.back() - point)));
    nearest.distance = std::min(nearest.distance, distances.back());
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (distances[i] > nearest.distance * (1 + kSameDistance)) continue;
    if (!nearest.bones.empty() && nearest.bones.back() == segments[i].bone) continue;
    nearest.bones.push_back(segments[i].bone);
    nearest.places.push_back(places[i]);
  }
  return nearest;
}

/// Keeps the bones that the point sees, if it sees any.
void look(const Sight& sight, Index point, Nearest& nearest) {
  std::vector<Index> seen;
  for (std::size_t i = 0; i < nearest.bones.size(); ++i)
    if (sight.is_clear(point, nearest.places[i])) seen.push_back(nearest.bones[i]);
  nearest.is_seen = !seen.empty();
  if (nearest.is_seen) nearest.bones = std::move(seen);
}

class Flow {
 public:
  Flow(const WeldedSurface& surface, std::span<const BoneSegment> segments, double heat)
      : surface_(surface), heat_(heat), stiffness_(make_stiffness(surface)) {
    const Sight sight(surface);
    for (Index point = 0; point < surface.point_count(); ++point) {
      nearest_.push_back(find_nearest(segments, surface.positions[point]));
      if (surface.part_of_point[point] != kNone) look(sight, point, nearest_.back());
    }
    weights_.edges = stiffness_.edges;
    weights_.clamped_edges = stiffness_.clamped_edges;
    weights_.rows.resize(surface.positions.size());
  }

  Result<HeatWeights> run() {
    heat_blind_parts();
    set_sources();
    Eigen::SparseMatrix<double> system = stiffness_.matrix;
    for (Index point = 0; point < conductance_.size(); ++point)
      system.coeffRef(point, point) += conductance_[point];
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(system);
    if (factors.info() != Eigen::Success) return failure();
    for (Index bone = 0; bone < sources_.size(); ++bone) {
      if (sources_[bone].empty()) continue;
      Eigen::VectorXd right = Eigen::VectorXd::Zero(system.rows());
      for (const auto& [point, value] : sources_[bone]) right[point] = value;
      const Eigen::VectorXd shares = factors.solve(right);
      if (!shares.allFinite()) return failure();
      for (Index point = 0; point < weights_.rows.size(); ++point)
        if (shares[point] > kLeastWeight) weights_.rows[point].push_back({bone, shares[point]});
    }
    finish_rows();
    return std::move(weights_);
  }

 private:
  static Status failure() {
    return Status::failure(StatusCode::internal_error, kNone,
                           "the matrix of the heat's flow cannot be factorised");
  }

  /// Points of a part that sees no bone count as seeing their nearest bones.
  void heat_blind_parts() {
    std::vector<bool> sees(surface_.part_count, false);
    for (Index point = 0; point < nearest_.size(); ++point) {
      const Index part = surface_.part_of_point[point];
      if (part == kNone) ++weights_.lone_points;
      if (!nearest_[point].is_seen) continue;
      sees[part] = true;
      ++weights_.heated_points;
    }
    for (Index point = 0; point < nearest_.size(); ++point) {
      const Index part = surface_.part_of_point[point];
      if (part == kNone || !sees[part]) nearest_[point].is_seen = true;
    }
    weights_.parts_without_sight = static_cast<std::uint32_t>(std::ranges::count(sees, false));
  }

  void set_sources() {
    const double least = kLeastDistance * surface_.diagonal;
    for (Index point = 0; point < nearest_.size(); ++point) {
      const Nearest& nearest = nearest_[point];
      conductance_.push_back(0);
      if (!nearest.is_seen) continue;
      const auto count = static_cast<double>(nearest.bones.size());
      const double distance = std::max(nearest.distance, least);
      const double of_bone =
          distance > 0 ? stiffness_.mass[point] * heat_ / (distance * distance) : 1.0;
      conductance_.back() = count * of_bone;
      for (const Index bone : nearest.bones) {
        if (bone >= sources_.size()) sources_.resize(bone + 1);
        sources_[bone].emplace_back(point, of_bone);
      }
    }
  }

  /// Rounding may leave a row that does not sum to one, or, far from all sources, an empty one.
  void finish_rows() {
    for (Index point = 0; point < weights_.rows.size(); ++point) {
      WeightRow& row = weights_.rows[point];
      if (row.empty())
        for (const Index bone : nearest_[point].bones) row.push_back({bone, 1.0});
      double sum = 0;
      for (const BoneWeight& entry : row) sum += entry.weight;
      for (BoneWeight& entry : row) entry.weight /= sum;
    }
  }

  const WeldedSurface& surface_;
  double heat_;
  Stiffness stiffness_;
  std::vector<Nearest> nearest_;
  std::vector<double> conductance_;                             ///< H, per point.
  std::vector<std::vector<std::pair<Index, double>>> sources_;  ///< H p, per bone.
  HeatWeights weights_;
};

}  // namespace

Result<HeatWeights> heat_weights(const WeldedSurface& surface,
                                 std::span<const BoneSegment> segments, double heat) {
  return Flow(surface, segments, heat).run();
}

}  // namespace sunder::binding
