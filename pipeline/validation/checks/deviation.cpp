#include "pipeline/validation/checks/deviation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace sunder::validation {

void Spread::add(double length) {
  ++count_;
  sum_ += length;
  square_ += length * length;
  maximum_ = std::max(maximum_, length);
  if (!(length > 0.0)) return;
  // The exponent and the first six bits of the mantissa number the bin.
  const auto bits = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(length) >> 46);
  const std::int64_t bin = bits - std::int64_t{1023 + kLowest} * kPerOctave;
  ++bins_[static_cast<std::size_t>(
      std::clamp<std::int64_t>(bin, 0, std::int64_t{kOctaves} * kPerOctave - 1))];
}

double Spread::mean() const { return count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_); }

double Spread::rms() const {
  return count_ == 0 ? 0.0 : std::sqrt(square_ / static_cast<double>(count_));
}

double Spread::percentile95() const {
  const auto above = static_cast<std::uint64_t>(0.05 * static_cast<double>(count_));
  std::uint64_t seen = 0;
  for (std::size_t bin = bins_.size(); bin-- > 0;) {
    seen += bins_[bin];
    if (seen <= above) continue;
    const std::uint64_t next = (std::uint64_t{1023 + kLowest} * kPerOctave + bin + 1) << 46;
    return std::min(maximum_, std::bit_cast<double>(next));
  }
  return 0.0;
}

void raise_largest(const SkinDifferences& rows, const PoseBatch& batch, std::span<double> largest) {
  for_each_block(batch, batch.poses.size(), [&](const PoseBlock& block) {
    for (std::size_t row = 0; row < largest.size(); ++row) {
      const auto terms = terms_of(rows, row);
      if (!terms.empty())
        largest[row] = std::max(largest[row], block.pose(terms).length().maxCoeff());
    }
  });
}

namespace {

/// The vertices that have terms, with the mean edge at each.
struct MovedVertex {
  Index vertex = 0;
  double edge = 0.0;
};

std::vector<MovedVertex> moved_vertices(const RowReader& reader,
                                        const SkinDifferences& differences) {
  std::vector<MovedVertex> moved;
  const Skinned& target = reader.target();
  const double unit = target.metres_per_bind_unit;
  for (Index v = 0; v < target.surface.vertex_count(); ++v)
    if (!terms_of(differences, v).empty())
      moved.push_back({v, unit * target.graph.mean_length(target.surface.weld.point_of_vertex[v])});
  return moved;
}

struct Worst {
  Index vertex = kNone;
  std::size_t pose = 0;
  double value = 0.0;
};

PosedFigures figures_of(const PoseBatch& batch, const SkinDifferences& differences,
                        std::span<const MovedVertex> moved, std::vector<float>& largest,
                        Worst& worst) {
  PosedFigures figures;
  for (const float value : largest) figures.sample_count += !std::isnan(value);
  figures.poses = batch.name;
  figures.pose_count = static_cast<std::uint32_t>(batch.poses.size());
  if (batch.poses.empty()) return figures;
  Spread spread;
  for_each_block(batch, batch.poses.size(), [&](const PoseBlock& block) {
    for (const MovedVertex& of : moved) {
      const PoseArray lengths = block.pose(terms_of(differences, of.vertex)).length();
      for (std::size_t i = 0; i < block.count(); ++i)
        spread.add(lengths[static_cast<Eigen::Index>(i)]);
      Eigen::Index at = 0;
      const double longest = lengths.maxCoeff(&at);
      if (of.edge > 0.0)
        figures.maximum_of_edge = std::max(figures.maximum_of_edge, longest / of.edge);
      largest[of.vertex] = std::max(largest[of.vertex], static_cast<float>(longest));
      if (longest > worst.value)
        worst = {of.vertex, block.first() + static_cast<std::size_t>(at), longest};
    }
  });
  spread.add_zeros((figures.sample_count - moved.size()) * batch.poses.size());
  figures.mean = spread.mean();
  figures.rms = spread.rms();
  figures.p95 = spread.percentile95();
  figures.maximum = spread.maximum();
  if (batch.is_independent)
    figures.covered_share = std::pow(0.05, 1.0 / static_cast<double>(batch.poses.size()));
  return figures;
}

}  // namespace

void measure_deviation(const RowReader& reader, const SkinDifferences& differences,
                       std::span<const PoseBatch> batches, const ModelPose& bind,
                       ValidationReport& report) {
  const std::vector<MovedVertex> moved = moved_vertices(reader, differences);
  const Skinned& target = reader.target();
  report.vertex_deviation.assign(target.surface.vertex_count(),
                                 std::numeric_limits<float>::quiet_NaN());
  for (Index mesh = 0; mesh < target.character.meshes.size(); ++mesh)
    for (Index v = 0; v < target.character.meshes[mesh].vertex_count(); ++v)
      if (reader.match(mesh, v).is_accepted)
        report.vertex_deviation[target.surface.first_vertex[mesh] + v] = 0.0f;
  double largest = 0.0;
  report.worst_pose = bind;
  for (const PoseBatch& batch : batches) {
    Worst worst;
    PosedFigures figures = figures_of(batch, differences, moved, report.vertex_deviation, worst);
    if (report.diagonal > 0.0) figures.maximum_of_diagonal = figures.maximum / report.diagonal;
    if (worst.vertex != kNone) {
      figures.worst = reader.target().place(worst.vertex, kNone, worst.value);
      if (worst.value > largest) report.worst_pose = model_pose(batch.poses[worst.pose], bind);
      largest = std::max(largest, worst.value);
    }
    report.posed.push_back(figures);
  }
}

void check_deviation(const RowReader& reader, const SkinPoints& points,
                     const SkinDifferences& differences, std::span<const PoseBatch> batches,
                     const ValidationReport& report, double threshold, double error_threshold,
                     FindingList& findings) {
  const Skinned& target = reader.target();
  SkinDifferences strays;
  std::vector<Index> vertices;
  Places places;
  TermSum sum = points.make_sum();
  for (Index mesh = 0; mesh < target.character.meshes.size(); ++mesh)
    for (Index v = 0; v < target.character.meshes[mesh].vertex_count(); ++v) {
      const Index vertex = target.surface.first_vertex[mesh] + v;
      const double on_surface = static_cast<double>(report.vertex_deviation[vertex]);
      if (terms_of(differences, vertex).empty()) continue;
      const SurfaceMatch& match = reader.match(mesh, v);
      if (match.distance == 0.0 && corner_of(match) < 3) {  // on a vertex: nothing to interpolate
        if (on_surface > threshold) places.push_back(target.place(vertex, kNone, on_surface));
        continue;
      }
      points.add_target(mesh, v, 1.0, sum);
      points.add_expected(mesh, v, -1.0, sum);
      sum.finish(strays);
      vertices.push_back(vertex);
    }
  std::vector<double> largest(vertices.size(), 0.0);
  std::size_t poses = 0;
  for (const PoseBatch& batch : batches) {
    raise_largest(strays, batch, largest);
    poses += batch.poses.size();
  }
  for (std::size_t i = 0; i < vertices.size(); ++i)
    if (largest[i] > threshold) places.push_back(target.place(vertices[i], kNone, largest[i]));
  const bool is_error = std::ranges::any_of(
      places, [&](const FindingPlace& place) { return place.value > error_threshold; });
  findings.add(
      Code::deviation, std::move(places),
      "Over " + std::to_string(poses) + " poses; the limit is " + std::to_string(threshold) + " m.",
      Evidence::sampled);
  if (is_error) findings.raise_to_error(Code::deviation);
}

}  // namespace sunder::validation
