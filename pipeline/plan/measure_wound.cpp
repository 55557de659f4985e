#include "pipeline/plan/measure_wound.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "pipeline/plan/posed_places.h"

namespace sunder::plan {
namespace {

constexpr std::uint32_t kClipSamples = 8;  ///< Poses per clip in which lips are measured.
constexpr std::size_t kMostPoses = 48;

/// The edges of lips, with ends as places in triangles of the source.
struct LipEdges {
  std::vector<SurfaceAnchor> ends;
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< Indices in `ends`.
};

/// A corner of a triangle of a torn model as a place in the source.
SurfaceAnchor place_of(const TornModel& model, std::uint32_t mesh, std::uint32_t triangle,
                       std::uint32_t corner) {
  const std::uint32_t vertex = model.character().meshes[mesh].triangles[triangle][corner];
  const Mesh& source = model.source().meshes[mesh];
  if (vertex >= source.vertex_count()) return {mesh, model.birth(mesh, vertex)};
  Birth birth{model.source_triangle(mesh, triangle), {0, 0, 0}};
  for (std::size_t i = 0; i < 3; ++i)
    birth.barycentric[i] = source.triangles[birth.triangle][i] == vertex ? 1 : 0;
  return {mesh, birth};
}

/// Edges with one triangle only, between points that an operation made or opened.
class LipFinder {
 public:
  LipFinder(const TornModel& model, const std::vector<ChangeRecord>& changes) : model_(model) {
    for (const ChangeRecord& change : changes) {
      for (std::uint32_t i = 0; i < change.point_count; ++i) points_.insert(change.first_point + i);
      for (const LipPair& pair : change.lips) points_.insert({pair.left, pair.right});
    }
  }

  LipEdges run() {
    const Character& torn = model_.character();
    for (std::uint32_t mesh = 0; mesh < torn.meshes.size(); ++mesh)
      for (std::uint32_t triangle = 0; triangle < torn.meshes[mesh].triangle_count(); ++triangle)
        if (!is_retired(torn.meshes[mesh].triangles[triangle])) add(mesh, triangle);
    LipEdges lips;
    std::map<std::uint32_t, std::uint32_t> index_of_point;
    for (const auto& [points, place] : edges_) {
      if (place.is_inner) continue;
      std::array<std::uint32_t, 2> edge{};
      for (std::uint32_t i = 0; i < 2; ++i) {
        const std::uint32_t corner = (place.corner + i) % 3;
        const auto next = static_cast<std::uint32_t>(lips.ends.size());
        const auto [found, is_new] =
            index_of_point.emplace(model_.point_at(place.mesh, place.triangle, corner), next);
        if (is_new) lips.ends.push_back(place_of(model_, place.mesh, place.triangle, corner));
        edge[i] = found->second;
      }
      lips.edges.push_back(edge);
    }
    return lips;
  }

 private:
  struct Edge {
    std::uint32_t mesh, triangle, corner;
    bool is_inner = false;
  };

  void add(std::uint32_t mesh, std::uint32_t triangle) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = model_.point_at(mesh, triangle, corner);
      const std::uint32_t b = model_.point_at(mesh, triangle, (corner + 1) % 3);
      if (points_.count(a) == 0 || points_.count(b) == 0) continue;
      const auto [found, is_new] =
          edges_.emplace(std::pair(std::min(a, b), std::max(a, b)), Edge{mesh, triangle, corner});
      if (!is_new) found->second.is_inner = true;
    }
  }

  const TornModel& model_;
  std::set<std::uint32_t> points_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Edge> edges_;
};

Vec3d nearest_on_segment(const Vec3d& place, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = b - a;
  const double square = along.squaredNorm();
  const double share = square > 0 ? std::clamp((place - a).dot(along) / square, 0.0, 1.0) : 0;
  return a + share * along;
}

double distance_to_segment(const Vec3d& place, const Vec3d& a, const Vec3d& b) {
  return (nearest_on_segment(place, a, b) - place).norm();
}

/// Distances in one pose.
class PosedDistances {
 public:
  PosedDistances(const PosedPlaces& curve, const PosedPlaces& lips, const LipEdges& edges)
      : curve_(curve), lips_(lips), edges_(edges), on_curve_(curve.size()), on_lips_(lips.size()) {}

  Status pose(const ModelPose& pose) {
    if (const Status status = curve_.pose(pose, on_curve_, {}); !status) return status;
    return lips_.pose(pose, on_lips_, {});
  }

  [[nodiscard]] double from_curve(std::size_t i) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : edges_.edges)
      least = std::min(least, distance_to_segment(on_curve_[i], on_lips_[a], on_lips_[b]));
    return least;
  }

  /// From the nearest place of the lips to a place of the curve.
  [[nodiscard]] Vec3d from_lips(std::size_t i) const {
    Vec3d least = Vec3d::Constant(std::numeric_limits<double>::infinity());
    for (const auto& [a, b] : edges_.edges) {
      const Vec3d from = on_curve_[i] - nearest_on_segment(on_curve_[i], on_lips_[a], on_lips_[b]);
      if (from.squaredNorm() < least.squaredNorm()) least = from;
    }
    return least;
  }

  /// The largest distance, and the place of the curve where it is.
  struct Farthest {
    double distance = 0;
    std::size_t at = 0;
  };
  [[nodiscard]] Farthest hausdorff() const {
    Farthest most;
    const auto take = [&](const Farthest& other) {
      if (other.distance > most.distance) most = other;
    };
    for (std::size_t i = 0; i < on_curve_.size(); ++i) take({from_curve(i), i});
    for (const auto& [a, b] : edges_.edges) {
      take(to_curve(on_lips_[a]));
      take(to_curve(on_lips_[b]));
      take(to_curve(0.5 * (on_lips_[a] + on_lips_[b])));
    }
    return most;
  }

  [[nodiscard]] double mean() const {
    double sum = 0;
    for (std::size_t i = 0; i < on_curve_.size(); ++i) sum += from_curve(i);
    return sum / static_cast<double>(on_curve_.size());
  }

 private:
  [[nodiscard]] Farthest to_curve(const Vec3d& place) const {
    Farthest least{std::numeric_limits<double>::infinity(), 0};
    for (std::size_t i = 1; i < on_curve_.size(); ++i) {
      const double distance = distance_to_segment(place, on_curve_[i - 1], on_curve_[i]);
      if (distance < least.distance) least = {distance, i};
    }
    return least;
  }

  const PosedPlaces& curve_;
  const PosedPlaces& lips_;
  const LipEdges& edges_;
  std::vector<Vec3d> on_curve_, on_lips_;
};

/// WoundMeasures::missed_by, averaged over some anchors to each side.
Result<std::vector<Vec2d>> missed_by(const TargetPath& path, const PosedDistances& distances,
                                     const ModelPose& pose) {
  constexpr std::size_t kWindow = 2;
  PosedPath posed;
  if (const Status status = path.pose(pose, posed); !status) return status;
  const std::size_t count = posed.places.size();
  std::vector<Vec2d> each(count), averaged(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d along =
        direction_at(posed.places[i - std::min(i, kWindow)],
                     posed.places[std::min(i + kWindow, count - 1)], posed.normals[i]);
    const Vec3d from = distances.from_lips(i);
    each[i] = Vec2d(from.dot(along), from.dot(posed.normals[i].cross(along)));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t side = std::min({kWindow, i, count - 1 - i});  // ends stay
    averaged[i] = Vec2d::Zero();
    for (std::size_t k = i - side; k <= i + side; ++k)
      averaged[i] += each[k] / static_cast<double>(2 * side + 1);
  }
  return averaged;
}

/// Poses of all clips, at even steps; none without clips.
Result<std::vector<ModelPose>> clip_poses(const std::shared_ptr<const Character>& character) {
  std::vector<ModelPose> poses;
  PoseSetSpec spec;
  spec.clip_samples = kClipSamples;
  const Result<PoseSet> set = PoseSet::create(character, spec);
  if (!set && set.error().code() == StatusCode::empty_input) return poses;  // there are no clips
  if (!set) return set.error();
  const std::size_t count = set->size(PoseSet::Role::fit);
  const std::size_t stride = (count + kMostPoses - 1) / kMostPoses;
  for (std::size_t i = 0; i < count; i += stride) {
    poses.emplace_back();
    if (const Status status = set->compute(PoseSet::Role::fit, i, poses.back()); !status)
      return status;
  }
  return poses;
}

}  // namespace

Result<WoundMeasures> measure_wound(const std::shared_ptr<const Character>& character,
                                    const TargetPath& path, const TearOperation& tear,
                                    const ModelPose& pose) {
  TearOperation plain = tear;
  plain.options = {};
  plain.options.layers = tear.options.layers;
  plain.options.weights = tear.options.weights;
  Result<TornModel> model = TornModel::create(character);
  if (!model) return model.error();
  std::vector<ChangeRecord> changes;
  const Result<TearReport> torn = apply_operation(*model, plain, &changes);
  if (!torn) return torn.error();
  WoundMeasures measures;
  measures.torn = *torn;
  const LipEdges edges = LipFinder(*model, changes).run();
  if (edges.edges.empty()) {
    measures.hausdorff = measures.mean_distance = measures.hausdorff_in_clips =
        std::numeric_limits<double>::infinity();
    return measures;
  }
  const PosedPlaces curve(*character, path.anchors()), lips(*character, edges.ends);
  PosedDistances distances(curve, lips, edges);
  if (const Status status = distances.pose(pose); !status) return status;
  const PosedDistances::Farthest farthest = distances.hausdorff();
  measures.hausdorff = measures.hausdorff_in_clips = farthest.distance;
  measures.farthest_share =
      static_cast<double>(farthest.at) / static_cast<double>(curve.size() - 1);
  measures.mean_distance = distances.mean();
  Result<std::vector<Vec2d>> missed = missed_by(path, distances, pose);
  if (!missed) return missed.error();
  measures.missed_by = std::move(*missed);
  const Result<std::vector<ModelPose>> poses = clip_poses(character);
  if (!poses) return poses.error();
  for (const ModelPose& of_clip : *poses) {
    if (const Status status = distances.pose(of_clip); !status) return status;
    measures.hausdorff_in_clips =
        std::max(measures.hausdorff_in_clips, distances.hausdorff().distance);
  }
  return measures;
}

}  // namespace sunder::plan
