#include "tear/weights/refit_work.h"

#include <sunder/skinning/deform.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <tuple>

#include "tear/internal/surface.h"
#include "tear/surface/morph_displacement.h"

namespace sunder::tear {
namespace {

/// Edges between points of a weighing, and from them to vertices that stay, each once.
std::vector<RefitNeighbours> find_neighbours(const Weighing& weighing,
                                             const SurfaceEditor::Mark& begin,
                                             const SurfaceEditor& editor) {
  const auto number_of = [&](const SurfaceEditor::VertexRef& vertex) {
    const auto at = std::lower_bound(weighing.points.begin(), weighing.points.end(), vertex,
                                     [](const WeighedPoint& a, const auto& b) {
                                       return std::tie(a.vertex.mesh, a.vertex.vertex) <
                                              std::tie(b.mesh, b.vertex);
                                     });
    return at != weighing.points.end() && at->vertex == vertex
               ? static_cast<Index>(at - weighing.points.begin())
               : kNone;
  };
  struct Edge {
    Index a, b;
    SurfaceEditor::VertexRef end;  // the other one, if it is none of the points
    double length;
    [[nodiscard]] auto key() const { return std::tuple(a, b, end.mesh, end.vertex); }
  };
  std::vector<Edge> edges;
  const auto add_edges = [&](Index face) {
    if (editor.surface().corner_point[3 * face] == kNone) return;
    const Index mesh = editor.surface().triangle(face).mesh;
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const Index from = editor.vertex_at(h), to = editor.vertex_at(Surface::next(h));
      const auto original_from = editor.original(mesh, from),
                 original_to = editor.original(mesh, to);
      Index a = number_of(original_from), b = number_of(original_to);
      if (a == b) continue;
      const SurfaceEditor::VertexRef end = a == kNone   ? original_from
                                           : b == kNone ? original_to
                                                        : SurfaceEditor::VertexRef{};
      if (b < a) std::swap(a, b);  // kNone comes last
      const double length =
          (editor.born_position(mesh, from) - editor.born_position(mesh, to)).cast<double>().norm();
      edges.push_back({a, b, end, length});
    }
  };
  // Whoever has a vertex that was appended since was appended or changed since.
  editor.for_each_changed(begin, add_edges);
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

RefitWork::RefitWork(std::shared_ptr<const Character> from, WeightsOperation wanted, PoseSet over,
                     Weighing begin, const SurfaceEditor::Mark& since, const SurfaceEditor& editor)
    : source(std::move(from)),
      operation(std::move(wanted)),
      poses(std::move(over)),
      weighing(std::move(begin)) {
  points.reserve(weighing.points.size());
  for (const WeighedPoint& of : weighing.points) {
    const Mesh& mesh = editor.character().meshes[of.vertex.mesh];
    Point& point = points.emplace_back();
    editor.describe_exactly(of.vertex, source->rest_morph_weights, point.exact);
    point.skin = mesh.skin;
    point.morph = morph_displacement(mesh, of.vertex.vertex, source->rest_morph_weights);
    point.position = Vec3d(of.position.cast<double>()) + point.morph;
  }
  if (operation.refit.is_coupled) neighbours = find_neighbours(weighing, since, editor);
}

void RefitWork::run() {
  using State = RefitJob::State;
  State expected = State::waiting;
  if (!state.compare_exchange_strong(expected, State::running)) return;
  try {
    for (Index skin = 0; skin < source->skins.size() && failure && !is_cancelled; ++skin)
      if (std::any_of(points.begin(), points.end(),
                      [&](const Point& point) { return point.skin == skin; }))
        failure = fit(skin);
    weighing.influences.swap(fitted_);
  } catch (const std::bad_alloc&) {
    failure = Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
  expected = State::running;
  state.compare_exchange_strong(expected, is_cancelled ? State::cancelled
                                          : failure    ? State::done
                                                       : State::failed);
}

void RefitWork::cancel() {
  using State = RefitJob::State;
  is_cancelled = true;
  for (State from : {State::waiting, State::running, State::done})
    state.compare_exchange_strong(from, State::cancelled);
}

template <class Fit>
void RefitWork::take(std::size_t i, const Fit& fit) {
  // Better by more than what it may lose when it is stored: a rounding of each coordinate, and of
  // the weights.
  constexpr double kStored = 1.5e-7;
  const bool is_taken =
      fit.is_better && std::sqrt(fit.mean_square) + kStored * fit.position.norm() <
                           std::sqrt(fit.barycentric_mean_square);
  WeighedPoint& point = weighing.points[i];
  const auto kept = std::span<const Influence>(weighing.influences)
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

Status RefitWork::fit(Index skin) {
  const auto is_of_skin = [&](const Point& point) { return point.skin == skin; };
  std::vector<std::size_t> of_skin;
  Vec3d centre = Vec3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_of_skin(points[i])) continue;
    of_skin.push_back(i);
    centre += points[i].position;
  }
  centre /= static_cast<double>(of_skin.size());
  PoseMoments moments(source->skins[skin].bones.size(), centre);
  for (const std::size_t i : of_skin) moments.want(points[i].exact);
  std::vector<Affine3d> palette(source->skins[skin].bones.size());
  ModelPose pose;
  for (std::size_t i = 0; i < poses.size(PoseSet::Role::fit); ++i) {
    if (is_cancelled) return {};
    poses.compute(PoseSet::Role::fit, i, pose);
    if (Status status = compute_palette(source->skins[skin], pose, palette); !status) return status;
    moments.add(palette);
  }
  const PointRefit::Options options = {operation.weights.maximum_influences,
                                       operation.refit.moves_bind};
  const auto to_refit = [&](std::size_t i) {
    const WeighedPoint& of = weighing.points[i];
    return PointToRefit{&points[i].exact, points[i].position,
                        std::span<const Influence>(weighing.influences)
                            .subspan(of.first_influence, of.influence_count)};
  };
  if (operation.refit.is_coupled) {
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
    auto fits = refit_coupled(together, of_these, {options, operation.refit.smoothness}, moments);
    if (!fits) return fits.error();
    for (std::size_t i = 0; i < of_skin.size(); ++i) {
      take(of_skin[i], (*fits)[i]);
    }
    return {};
  }
  PointRefit refit;
  for (const std::size_t i : of_skin) {
    if (is_cancelled) return {};
    take(i, refit.fit(to_refit(i), options, moments));
  }
  return {};
}

}  // namespace sunder::tear
