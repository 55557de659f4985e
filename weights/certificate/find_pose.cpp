// Poses that come close to what is certified.

#include <sunder/certificate/certificate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <optional>

#include <Eigen/Eigenvalues>

#include "weights/certificate/blend_matrices.h"
#include "weights/certificate/pose_search.h"

namespace sunder {
namespace certificate {
namespace {

constexpr int kRounds = 12;

Status check_point(const JointTree::State& tree, const SkinDifferences& rows, std::uint32_t point) {
  if (const Status status = check_rows(tree, rows); !status) return status;
  if (point + std::size_t{1} >= rows.first.size())
    return Status::failure(StatusCode::index_out_of_range, point, "point %u does not exist: %zu",
                           point, rows.first.size() - 1);
  return {};
}

FoundPose worst_pose_of(const JointTree::State& tree, std::span<const SkinTerm> terms,
                        const SearchOptions& options) {
  if (terms.empty()) return PoseSearch(tree, terms, PoseSearch::Goal::longest).pose();
  std::mt19937_64 random(options.seed);
  PoseSearch search(tree, terms, PoseSearch::Goal::longest);
  std::optional<PoseSearch> best;
  double found = -1;
  for (std::uint32_t start = 0; start <= options.restarts; ++start) {
    if (start > 0) search.start_at_random(random);
    const double value = search.improve_fully();
    if (!(value > found)) continue;
    found = value;
    best.emplace(search);
  }
  FoundPose pose = best->pose();
  pose.found = best->measure(terms);
  return pose;
}

/// The blended matrix, and its smallest singular value with the vector that it shrinks so.
struct Blend {
  double smallest = 0.0;
  Vec3d direction = Vec3d::UnitX();
};

/// @param relative  see relative_to_bind().
Vec3d at_bind(std::span<const Mat3d> relative, std::size_t term, const Vec3d& direction) {
  return relative.empty() ? direction : Vec3d(multiply(relative[term], direction));
}

Blend blend_of(const PoseSearch& search, std::span<const SkinTerm> points,
               std::span<const Mat3d> relative) {
  const std::vector<Affine3d> matrices = search.model_from_bind();
  Mat3d sum = Mat3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Mat3d linear = points[i].m * matrices[points[i].bone].linear();
    sum += relative.empty() ? linear : Mat3d(multiply(linear, relative[i]));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> squares(sum.transpose() * sum);
  const Vec3d direction = normalized(Vec3d(squares.eigenvectors().col(0)));
  return {norm(multiply(sum, direction)), direction};
}

/// Turns by turns: the direction that is shrunk most, and the pose that shrinks it more.
FoundPose collapse_pose_of(const JointTree::State& tree, std::span<const SkinTerm> points,
                           std::span<const Mat3d> relative, const SearchOptions& options) {
  std::vector<SkinTerm> terms(points.begin(), points.end());
  for (SkinTerm& term : terms) term.m = 0;
  std::mt19937_64 random(options.seed);
  PoseSearch search(tree, terms, PoseSearch::Goal::shortest);
  FoundPose best = search.pose();
  best.found = blend_of(search, points, relative).smallest;
  for (std::uint32_t start = 0; start <= options.restarts; ++start) {
    if (start > 0) search.start_at_random(random);
    Blend blend = blend_of(search, points, relative);
    for (int round = 0; round < kRounds; ++round) {
      const double before = blend.smallest;
      for (std::size_t i = 0; i < terms.size(); ++i)
        terms[i].x = points[i].m * at_bind(relative, i, blend.direction);
      search.set_positions(terms);
      search.improve_fully();
      blend = blend_of(search, points, relative);
      if (blend.smallest < best.found) {
        best = search.pose();
        best.found = blend.smallest;
      }
      if (round > 2 && std::abs(blend.smallest - before) < 1e-7) break;
    }
  }
  return best;
}

/// Whether a scale between the points, or above them, has no range.
std::uint32_t unscaled_bone(const JointTree::State& tree, std::span<const SkinTerm> terms) {
  for (const SkinTerm& term : terms)
    if (const std::uint32_t bone = tree.nodes[tree.node_of_bone[term.bone]].unscaled_bone;
        bone != kNone)
      return bone;
  return kNone;
}

}  // namespace
}  // namespace certificate

Result<FoundPose> find_worst_pose(const JointTree& tree, const SkinDifferences& differences,
                                  std::uint32_t point, const SearchOptions& options) {
  using namespace certificate;
  try {
    if (const Status status = check_point(tree.state(), differences, point); !status) return status;
    const auto terms = row_of(differences, point);
    PathGap gap;
    if (find_gap(tree.state(), terms, gap))
      return Status::failure(StatusCode::unsupported_feature, point,
                             gap.bone == kNone
                                 ? "point %u: no pose is worst, its sums of weights differ"
                                 : "point %u: no pose is worst, bone %u moves without a range",
                             point, gap.bone);
    return worst_pose_of(tree.state(), terms, options);
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

Result<FoundPose> find_collapse_pose(const JointTree& tree, const SkinBlends& blends,
                                     std::uint32_t point, const SearchOptions& options) {
  using namespace certificate;
  try {
    if (const Status status = check_blends(tree.state(), blends); !status) return status;
    if (const Status status = check_point(tree.state(), blends.points, point); !status)
      return status;
    const auto terms = row_of(blends.points, point);
    std::vector<Mat3d> relative;
    if (!relative_to_bind(terms, at_bind_of(blends, point), relative))
      return Status::failure(StatusCode::unsupported_feature, point,
                             "point %u: its blended matrix is flat at bind, or parts of it mirror "
                             "each other",
                             point);
    if (const std::uint32_t bone = unscaled_bone(tree.state(), terms); bone != kNone)
      return Status::failure(StatusCode::unsupported_feature, point,
                             "point %u: bone %u scales without a range", point, bone);
    return collapse_pose_of(tree.state(), terms, relative, options);
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

}  // namespace sunder
