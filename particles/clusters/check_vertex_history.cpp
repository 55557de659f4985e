#include "particles/clusters/check_vertex_history.h"

#include <unordered_map>
#include <utility>
#include <vector>

#include "particles/clusters/torn_meshes.h"
#include "tear/internal/former_triangles.h"

namespace sunder::particles {
namespace {

/// The points of vertices while operations are undone, as recorded and as faces use them. Counts
/// the corners of all vertices of faces that some operation changed or made.
class UndoneVertices {
 public:
  UndoneVertices(const Structure& structure, const TornModel& model,
                 const std::vector<tear::TriangleHistory>& histories)
      : model_(model),
        points_(structure.vertex_points.of_mesh),
        end_(model.surface().triangle_count()) {
    for (const auto& of_mesh : points_) watched_.emplace_back(of_mesh.size(), kNone);
    for (Index t = histories.empty() ? end_ : histories[0].count; t < end_; ++t) watch(t, now(t));
    for (const tear::TriangleHistory& history : histories)
      for (const tear::FormerTriangle& former : history.former) watch(former.triangle, former);
    for (const Change& change : structure.tears.done)
      for (const Change::OfVertex& of : change.changed_vertices) watch({of.mesh, of.vertex});
    for (Index t = 0; t < end_; ++t) count(t, now(t), 1);
  }

  /// @return a vertex that is not at one of its points then, or kNone.
  [[nodiscard]] Index undo(const Change& change, const tear::TriangleHistory& history) {
    touched_.clear();
    for (Index t = history.count; t < end_; ++t) exchange(t, nullptr);
    end_ = history.count;
    for (const tear::FormerTriangle& former : history.former) exchange(former.triangle, &former);
    for (auto of = change.changed_vertices.rbegin(); of != change.changed_vertices.rend(); ++of) {
      points_[of->mesh][of->vertex] = of->point;
      touched_.emplace_back(of->mesh, of->vertex);
    }
    for (std::size_t m = 0; m < points_.size(); ++m) points_[m].resize(change.vertices[m]);
    for (const Vertex& vertex : touched_)
      if (vertex.second < points_[vertex.first].size() && !is_at_its_point(vertex))
        return vertex.second;
    return kNone;
  }
  [[nodiscard]] bool is(const Structure& decomposition) const {
    return points_ == decomposition.vertex_points.of_mesh;
  }

 private:
  using Vertex = std::pair<Index, Index>;  ///< Mesh and vertex.

  [[nodiscard]] tear::FormerTriangle now(Index triangle) const {
    const tear::Surface& surface = model_.surface();
    const tear::TriangleRef ref = surface.triangle(triangle);
    const Index* const points = &surface.corner_point[3 * triangle];
    return {triangle,
            {points[0], points[1], points[2]},
            model_.character().meshes[ref.mesh].triangles[ref.triangle]};
  }
  void watch(Index triangle, const tear::FormerTriangle& as) {
    const Index mesh = model_.surface().triangle(triangle).mesh;
    for (const Index vertex : as.vertices) watch({mesh, vertex});
  }
  void watch(const Vertex& vertex) {
    Index& place = watched_[vertex.first][vertex.second];
    if (place != kNone) return;
    place = static_cast<Index>(first_use_.size());
    first_use_.push_back(kNone);
  }
  /// A triangle becomes what it was before; null: it was not there.
  void exchange(Index triangle, const tear::FormerTriangle* before) {
    const auto found = former_.find(triangle);
    count(triangle, found != former_.end() ? *found->second : now(triangle), -1);
    if (before == nullptr) return;
    former_[triangle] = before;
    count(triangle, *before, 1);
  }
  void count(Index triangle, const tear::FormerTriangle& as, int sign) {
    const auto& p = as.points;
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) return;
    const Index mesh = model_.surface().triangle(triangle).mesh;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vertex vertex(mesh, as.vertices[k]);
      if (watched_[mesh][vertex.second] == kNone) continue;
      use_of(vertex, p[k]).corners += sign;
      touched_.push_back(vertex);
    }
  }
  /// How many corners of faces are a vertex at a point.
  struct Use {
    Index point = 0;
    int corners = 0;
    Index next = kNone;  ///< Of the same vertex, in `uses_`.
  };
  Use& use_of(const Vertex& vertex, Index point) {
    Index* at = &first_use_[watched_[vertex.first][vertex.second]];
    for (; *at != kNone; at = &uses_[*at].next)
      if (uses_[*at].point == point) return uses_[*at];
    *at = static_cast<Index>(uses_.size());
    return uses_.emplace_back(Use{point, 0, kNone});
  }
  [[nodiscard]] bool is_at_its_point(const Vertex& vertex) const {
    const Index point = points_[vertex.first][vertex.second];
    bool is_used = false;
    for (Index at = first_use_[watched_[vertex.first][vertex.second]]; at != kNone;
         at = uses_[at].next) {
      if (uses_[at].corners == 0) continue;
      if (uses_[at].point == point) return true;
      is_used = true;
    }
    return !is_used && point == kNone;
  }

  const TornModel& model_;
  std::vector<std::vector<Index>> points_;  ///< Per mesh and vertex: VertexPoints::of_mesh.
  /// Per mesh and vertex: its place in `first_use_`; kNone: it is not counted.
  std::vector<std::vector<Index>> watched_;
  Index end_;                     ///< Triangles that there are.
  std::vector<Index> first_use_;  ///< Per vertex that is counted, in `uses_`; kNone: none.
  std::vector<Use> uses_;
  std::unordered_map<Index, const tear::FormerTriangle*> former_;
  std::vector<Vertex> touched_;  ///< By the operation that is being undone; repeated.
};

}  // namespace

Status check_vertex_history(const Structure& structure, const Structure& decomposition,
                            const TornModel& model) {
  const std::vector<tear::TriangleHistory> histories = tear::triangles_before_operations(model);
  const std::vector<Change>& done = structure.tears.done;
  UndoneVertices undone(structure, model, histories);
  for (std::size_t i = done.size(); i-- > 0;)
    if (const Index vertex = undone.undo(done[i], histories[i]); vertex != kNone)
      return Status::failure(StatusCode::invalid_argument, static_cast<Index>(i),
                             "a recorded state of particles: vertex %u was not at its point before "
                             "operation %zu",
                             vertex, i);
  if (undone.is(decomposition)) return {};
  return Status::failure(StatusCode::invalid_argument, 0,
                         "a recorded state of particles: before the first operation its vertices "
                         "are not at the points of the decomposition");
}

}  // namespace sunder::particles
