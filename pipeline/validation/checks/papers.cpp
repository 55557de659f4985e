#include "pipeline/validation/checks/papers.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "pipeline/validation/checks/pose_block.h"

namespace sunder::validation {
namespace {

constexpr std::size_t kFrames = 10;  ///< As RigNet's evaluation.
constexpr double kInfluence = 1e-4;  ///< Weights above are influences.

/// Sums over all points and frames.
struct Sums {
  double error = 0.0;     ///< |A - B|^2.
  double distance = 0.0;  ///< |A - B|.
  double farthest = 0.0;
  double from_center = 0.0;  ///< |A - centroid of the frame|^2.
};

/// |A - centroid|^2 of one frame, from running sums.
struct Frame {
  Vec3d sum = Vec3d::Zero();
  double square = 0.0;
  double count = 0.0;

  void add(const Vec3d& place) {
    sum += place;
    square += squared_norm(place);
    count += 1.0;
  }
  [[nodiscard]] double about_center() const {
    return count > 0.0 ? square - squared_norm(sum) / count : 0.0;
  }
};

/// Influences and weights of matched vertices beside each other.
void compare_influences(const RowReader& reader, PaperFigures& figures) {
  std::uint64_t common = 0, of_target = 0, of_source = 0;
  double l1 = 0.0;
  std::uint64_t vertices = 0;
  WeightRow actual, expected;
  const auto& meshes = reader.target().character.meshes;
  for (Index mesh = 0; mesh < meshes.size(); ++mesh)
    for (Index v = 0; v < meshes[mesh].vertex_count(); ++v) {
      const SurfaceMatch& match = reader.match(mesh, v);
      if (!match.is_accepted) continue;
      ++vertices;
      reader.actual(mesh, v, actual);
      reader.expected(match, match.barycentric, expected);
      l1 += distance(actual, expected);
      for (const auto& [bone, weight] : actual) {
        of_target += weight > kInfluence;
        common += weight > kInfluence && weight_of(expected, bone) > kInfluence;
      }
      for (const auto& [bone, weight] : expected) of_source += weight > kInfluence;
    }
  if (of_target > 0)
    figures.influence_precision = static_cast<double>(common) / static_cast<double>(of_target);
  if (of_source > 0)
    figures.influence_recall = static_cast<double>(common) / static_cast<double>(of_source);
  if (vertices > 0) figures.weight_l1 = l1 / static_cast<double>(vertices);
  figures.points = static_cast<std::uint32_t>(vertices);
}

/// Adds one vertex of the target in the poses of a block.
/// @param frames  of the block.
void add_vertex(const PoseBlock& block, std::span<const SkinTerm> vertex,
                std::span<const SkinTerm> difference, std::span<Frame> frames, Sums& sums) {
  const PosedPoint error = block.pose(difference), source = block.pose(vertex) - error;
  const PoseArray squares = error.squared_length();
  for (std::size_t i = 0; i < block.count(); ++i) {
    const auto lane = static_cast<Eigen::Index>(i);
    frames[i].add({source.x[lane], source.y[lane], source.z[lane]});
    const double distance = std::sqrt(squares[lane]);
    sums.error += squares[lane];
    sums.distance += distance;
    sums.farthest = std::max(sums.farthest, distance);
  }
}

/// Over all matched vertices of the target.
Sums sum_over(const RowReader& reader, const SkinPoints& points, const SkinDifferences& differences,
              const PoseBatch& random, std::size_t frame_count) {
  const Skinned& target = reader.target();
  std::vector<PoseBlock> blocks;
  for_each_block(random, frame_count, [&](const PoseBlock& block) { blocks.push_back(block); });
  std::vector<Frame> frames(frame_count);
  Sums sums;
  TermSum sum = points.make_sum();
  SkinDifferences row;
  for (Index mesh = 0; mesh < target.character.meshes.size(); ++mesh)
    for (Index v = 0; v < target.character.meshes[mesh].vertex_count(); ++v) {
      if (!reader.match(mesh, v).is_accepted) continue;
      row.terms.clear();
      row.first.resize(1);
      points.add_target(mesh, v, 1.0, sum);
      sum.finish(row);
      for (const PoseBlock& block : blocks)
        add_vertex(block, row.terms, terms_of(differences, target.surface.first_vertex[mesh] + v),
                   std::span(frames).subspan(block.first(), block.count()), sums);
    }
  for (const Frame& frame : frames) sums.from_center += frame.about_center();
  return sums;
}

}  // namespace

PaperFigures measure_for_papers(const RowReader& reader, const SkinPoints& points,
                                const SkinDifferences& differences, const PoseBatch& random) {
  PaperFigures figures;
  const std::size_t frames = std::min(random.poses.size(), kFrames);
  figures.frames = static_cast<std::uint32_t>(frames);
  figures.is_tested = frames > 0;
  compare_influences(reader, figures);
  if (frames == 0 || figures.points == 0 || differences.terms.empty()) return figures;
  const Sums sums = sum_over(reader, points, differences, random, frames);
  const double samples = static_cast<double>(figures.points) * static_cast<double>(frames);
  if (sums.from_center > 0.0) figures.kg_error = 100.0 * std::sqrt(sums.error / sums.from_center);
  figures.rms = std::sqrt(sums.error / samples);
  if (const double diagonal = reader.source().rest_diagonal; diagonal > 0.0)
    figures.rms_1000 = 1000.0 * std::sqrt(sums.error / (3.0 * samples)) / diagonal;
  figures.distance_mean = sums.distance / samples;
  figures.distance_maximum = sums.farthest;
  return figures;
}

}  // namespace sunder::validation
