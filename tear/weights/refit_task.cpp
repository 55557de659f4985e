#include "tear/weights/refit_task.h"

#include <sunder/skinning/deform.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <tuple>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/surface/morph_displacement.h"

namespace sunder::tear {
namespace {

/// The edges between the points, and from them to vertices of the untorn surface, each once.
std::vector<RefitNeighbours> find_neighbours(const WeightAssignment& assignment,
                                             const EditLog::Mark& begin,
                                             const SurfaceEditor& editor) {
  const auto number_of = [&](const VertexRef& vertex) {
    const auto at = std::lower_bound(assignment.points.begin(), assignment.points.end(), vertex,
                                     [](const PointWeights& a, const auto& b) {
                                       return std::tie(a.vertex.mesh, a.vertex.vertex) <
                                              std::tie(b.mesh, b.vertex);
                                     });
    return at != assignment.points.end() && at->vertex == vertex
               ? static_cast<Index>(at - assignment.points.begin())
               : kNone;
  };
  struct Edge {
    Index a, b;
    VertexRef end;  // the untorn end, if there is one
    double length;
    [[nodiscard]] auto key() const { return std::tuple(a, b, end.mesh, end.vertex); }
  };
  std::vector<Edge> edges;
  const auto add_edges = [&](Index face) {
    if (editor.surface().corner_point[3 * face] == kNone) return;
    const Index mesh = editor.surface().triangle(face).mesh;
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const Index from = editor.vertex_at(h), to = editor.vertex_at(Surface::next(h));
      const auto original_from = editor.births.original(mesh, from),
                 original_to = editor.births.original(mesh, to);
      Index a = number_of(original_from), b = number_of(original_to);
      if (a == b) continue;
      const VertexRef end = a == kNone ? original_from : b == kNone ? original_to : VertexRef{};
      if (b < a) std::swap(a, b);  // kNone comes last
      const double length = norm(
          (editor.births.position(mesh, from) - editor.births.position(mesh, to)).cast<double>());
      edges.push_back({a, b, end, length});
    }
  };
  // Every face with a vertex that was appended since was itself appended or changed since.
  editor.log.for_each_changed(begin, add_edges);
  for (Index face = begin.triangles; face < editor.surface().triangle_count(); ++face)
    add_edges(face);
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.key() < b.key(); });
  edges.erase(std::unique(edges.begin(), edges.end(),
                          [](const Edge& a, const Edge& b) { return a.key() == b.key(); }),
              edges.end());
  std::vector<RefitNeighbours> neighbours;
  neighbours.reserve(edges.size());
  for (const Edge& edge : edges) neighbours.push_back({edge.a, edge.b, edge.length});
  return neighbours;
}

}  // namespace

RefitTask::RefitTask(std::shared_ptr<const Character> from, WeightsOperation wanted, PoseSet over,
                     WeightAssignment begin, const EditLog::Mark& since,
                     const SurfaceEditor& editor)
    : source(std::move(from)),
      operation(std::move(wanted)),
      poses(std::move(over)),
      assignment(std::move(begin)) {
  points.reserve(assignment.points.size());
  for (const PointWeights& of : assignment.points) {
    const Mesh& mesh = editor.character().meshes[of.vertex.mesh];
    Point& point = points.emplace_back();
    editor.births.describe_exactly(of.vertex, source->rest_morph_weights, point.exact);
    point.skin = mesh.skin;
    point.morph = morph_displacement(mesh, of.vertex.vertex, source->rest_morph_weights);
    point.position = Vec3d(of.position.cast<double>()) + point.morph;
  }
  if (operation.refit.is_coupled) neighbours = find_neighbours(assignment, since, editor);
}

void RefitTask::run() {
  using State = RefitJob::State;
  State expected = State::waiting;
  if (!state.compare_exchange_strong(expected, State::running)) return;
  try {
    for (Index skin = 0; skin < source->skins.size() && failure && !is_cancelled; ++skin)
      if (std::any_of(points.begin(), points.end(),
                      [&](const Point& point) { return point.skin == skin; }))
        failure = fit(skin);
    assignment.influences.swap(fitted_);
  } catch (const std::bad_alloc&) {
    failure = out_of_memory();
  }
  expected = State::running;
  state.compare_exchange_strong(expected, is_cancelled ? State::cancelled
                                          : failure    ? State::done
                                                       : State::failed);
}

void RefitTask::cancel() {
  using State = RefitJob::State;
  is_cancelled = true;
  for (State from : {State::waiting, State::running, State::done})
    state.compare_exchange_strong(from, State::cancelled);
}

template <class Fit>
void RefitTask::take(std::size_t i, const Fit& fit) {
  // The fit must be better by more than it may lose when it is stored: the rounding of coordinates
  // and weights.
  const bool is_taken =
      fit.is_better && std::sqrt(fit.mean_square) + kStoredFitLengths * norm(fit.position) <
                           std::sqrt(fit.barycentric_mean_square);
  PointWeights& point = assignment.points[i];
  const auto kept = std::span<const Influence>(assignment.influences)
                        .subspan(point.first_influence, point.influence_count);
  const std::span<const Influence> influences =
      is_taken ? std::span<const Influence>(fit.influences) : kept;
  if (is_taken && fit.position != points[i].position)
    point.position = (fit.position - points[i].morph).template cast<float>();
  point.first_influence = static_cast<Index>(fitted_.size());
  point.influence_count = static_cast<Index>(influences.size());
  fitted_.insert(fitted_.end(), influences.begin(), influences.end());
  report.refitted += is_taken ? 1 : 0;
}

Status RefitTask::fit(Index skin) {
  std::vector<std::size_t> of_skin;
  Vec3d centre = Vec3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].skin != skin) continue;
    of_skin.push_back(i);
    centre += points[i].position;
  }
  centre /= static_cast<double>(of_skin.size());
  PoseMoments moments(source->skins[skin].bones.size(), centre);
  for (const std::size_t i : of_skin) moments.want(points[i].exact);
  if (Status status = add_poses(skin, moments); !status) return status;
  if (is_cancelled) return {};
  if (operation.refit.is_coupled) return fit_together(of_skin, moments);
  PointRefit refit;
  for (const std::size_t i : of_skin) {
    if (is_cancelled) return {};
    take(i, refit.fit(to_refit(i), options(), moments));
  }
  return {};
}

/// Adds the poses to fit over. Stops early if the task is cancelled.
Status RefitTask::add_poses(Index skin, PoseMoments& moments) const {
  std::vector<Affine3d> palette(source->skins[skin].bones.size());
  ModelPose pose;
  for (std::size_t i = 0; i < poses.size(PoseSet::Role::fit) && !is_cancelled; ++i) {
    if (Status status = poses.compute(PoseSet::Role::fit, i, pose); !status) return status;
    if (Status status = compute_palette(source->skins[skin], pose, palette); !status) return status;
    moments.add(palette);
  }
  return {};
}

PointRefit::Options RefitTask::options() const {
  return {operation.weights.maximum_influences, operation.refit.moves_bind};
}

PointToRefit RefitTask::to_refit(std::size_t point) const {
  const PointWeights& of = assignment.points[point];
  return {&points[point].exact, points[point].position,
          std::span<const Influence>(assignment.influences)
              .subspan(of.first_influence, of.influence_count)};
}

/// Fits all points of a skin in one problem.
Status RefitTask::fit_together(std::span<const std::size_t> of_skin, const PoseMoments& moments) {
  std::vector<PointToRefit> together;
  std::vector<Index> number(points.size(), kNone);
  for (const std::size_t i : of_skin) {
    number[i] = static_cast<Index>(together.size());
    together.push_back(to_refit(i));
  }
  std::vector<RefitNeighbours> of_these;
  for (const RefitNeighbours& pair : neighbours) {
    const Index a = number[pair.a], b = pair.b == kNone ? kNone : number[pair.b];
    if (a != kNone && (b != kNone || pair.b == kNone)) of_these.push_back({a, b, pair.length});
  }
  auto fits = refit_coupled(together, of_these, {options(), operation.refit.smoothness}, moments);
  if (!fits) return fits.error();
  for (std::size_t i = 0; i < of_skin.size(); ++i) take(of_skin[i], (*fits)[i]);
  return {};
}

}  // namespace sunder::tear
