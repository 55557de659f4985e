#include "pipeline/validation/match/surface_match.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <tuple>
#include <unsupported/Eigen/BVH>

#include <Eigen/StdVector>

#include "core/internal/ordered.h"
#include "pipeline/validation/match/closest_on_triangle.h"
#include "pipeline/validation/match/position_table.h"

namespace sunder::validation {
namespace {

constexpr double kTie = 2e-7;             ///< Of the diagonal: equally close, for float positions.
constexpr double kMatchOnSurface = 1e-6;  ///< Of the diagonal: what float positions may be off.
constexpr double kRoughlyAgrees = 0.5;    ///< Cosine.
constexpr double kSameCosine = 0.05;      ///< Normals that agree equally well.

/// A place that competes to be the match of a vertex.
struct Candidate {
  Index triangle = kNone;  ///< Of all.
  std::array<double, 3> barycentric = {1.0, 0, 0};
  double distance = 0;
  double cosine = 1;
  bool agrees = false;  ///< Roughly: normals of flat and bent neighbours do.
  bool same_side = false, same_number = false, same_region = false;
};

/// Whether `a` is the better of two that are equally close.
bool is_better(const Candidate& a, const Candidate& b) {
  const auto rank = [](const Candidate& of) {
    return std::tuple(!of.agrees, !of.same_side, !of.same_number, !of.same_region);
  };
  if (rank(a) != rank(b)) return rank(a) < rank(b);
  if (std::abs(a.cosine - b.cosine) > kSameCosine) return a.cosine > b.cosine;
  return a.triangle < b.triangle;
}

/// The vertex whose match is sought.
struct Query {
  const BindSurface& of;
  Index vertex;

  [[nodiscard]] const Vec3d& position() const { return of.positions[vertex]; }
  [[nodiscard]] Index number() const { return vertex - of.first_vertex[of.mesh_of_vertex(vertex)]; }
  /// Whether a triangle of another surface is in the region of this vertex.
  [[nodiscard]] bool shares_region(const BindSurface& surface, Index triangle) const {
    const Index own = of.triangle_of_vertex[vertex];
    return own != kNone && of.region[own] == surface.region[triangle];
  }
};

double cosine_of(const Vec3d& own, const Vec3d& other, bool either_side) {
  const double length = norm(own) * norm(other);
  if (!(length > 0)) return 1;
  const double cosine = std::clamp(dot(own, other) / length, -1.0, 1.0);
  return either_side ? std::abs(cosine) : cosine;
}

/// Finds all triangles that are as close as the closest one, for BVMinimize. It answers a little
/// more than each distance, so that boxes that are equally close are searched too.
struct ClosestTriangles {
  using Scalar = double;

  const BindSurface& surface;
  Eigen::Vector3d place;
  double tie;
  std::vector<Candidate> found;
  double least = std::numeric_limits<double>::infinity();

  double minimumOnVolume(const Eigen::AlignedBox3d& box) const {
    return std::sqrt(box.squaredExteriorDistance(place));
  }
  double minimumOnObject(Index triangle) {
    const auto& [a, b, c] = surface.triangles[triangle];
    const PlaceOnTriangle closest = closest_on_triangle(place, surface.positions[a],
                                                        surface.positions[b], surface.positions[c]);
    if (closest.distance <= least + tie) {
      found.push_back({triangle, closest.barycentric, closest.distance});
      least = std::min(least, closest.distance);
    }
    return least + 2 * tie;
  }
};

/// Collects all triangles near a place, for BVIntersect.
struct NearTriangles {
  const BindSurface& surface;
  Eigen::Vector3d place;
  double distance;
  std::vector<SurfacePlace> found;

  bool intersectVolume(const Eigen::AlignedBox3d& box) const {
    return box.squaredExteriorDistance(place) <= distance * distance;
  }
  bool intersectObject(Index triangle) {
    const auto& [a, b, c] = surface.triangles[triangle];
    const PlaceOnTriangle closest = closest_on_triangle(place, surface.positions[a],
                                                        surface.positions[b], surface.positions[c]);
    if (closest.distance <= distance) found.push_back({triangle, closest.barycentric});
    return false;  // go on
  }
};

}  // namespace

struct SurfaceSearch::Tree {
  const BindSurface& surface;
  PositionTable vertices;
  std::vector<Index> usable;  ///< Triangles.

  Tree(const BindSurface& of, std::span<const Index> triangles);

  /// Built when the first vertex is sought that coincides with none.
  [[nodiscard]] const Eigen::KdBVH<double, 3, Index>& boxes() const;
  /// Members of a candidate that do not depend on its distance.
  void describe(const Query& query, const MatchLimits& limits, Candidate& candidate) const;
  [[nodiscard]] Candidate coincident(const Query& query, const MatchLimits& limits) const;
  [[nodiscard]] Candidate nearest(const Query& query, const MatchLimits& limits) const;

 private:
  mutable std::once_flag are_boxes_built_;
  mutable Eigen::KdBVH<double, 3, Index> boxes_;
};

SurfaceSearch::Tree::Tree(const BindSurface& of, std::span<const Index> triangles)
    : surface(of), vertices(std::min(of.positions.size(), 3 * triangles.size())) {
  std::vector<bool> is_known(of.positions.size(), false);
  for (const Index t : triangles) {
    if (!of.has_area[t]) continue;
    usable.push_back(t);
    for (const Index vertex : of.triangles[t]) {
      if (!is_known[vertex]) vertices.insert(of.positions[vertex], vertex);
      is_known[vertex] = true;
    }
  }
}

const Eigen::KdBVH<double, 3, Index>& SurfaceSearch::Tree::boxes() const {
  std::call_once(are_boxes_built_, [this] {
    std::vector<Eigen::AlignedBox3d> around(usable.size());
    for (std::size_t i = 0; i < usable.size(); ++i)
      for (const Index vertex : surface.triangles[usable[i]])
        around[i].extend(Eigen::Vector3d(surface.positions[vertex]));
    boxes_.init(usable.begin(), usable.end(), around.begin(), around.end());
  });
  return boxes_;
}

void SurfaceSearch::Tree::describe(const Query& query, const MatchLimits& limits,
                                   Candidate& candidate) const {
  Vec3d normal = Vec3d::Zero();
  candidate.same_side = true;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(candidate.barycentric[k] > 0)) continue;
    const Index vertex = surface.triangles[candidate.triangle][k];
    normal += candidate.barycentric[k] * surface.normals[vertex];
    candidate.same_side &= surface.tear_side[vertex] == query.of.tear_side[query.vertex];
  }
  candidate.cosine = cosine_of(query.of.normals[query.vertex], normal, limits.either_side);
  candidate.agrees = candidate.cosine >= std::max(kRoughlyAgrees, limits.cosine);
  candidate.same_region = query.shares_region(surface, candidate.triangle);
}

Candidate SurfaceSearch::Tree::coincident(const Query& query, const MatchLimits& limits) const {
  Candidate best;
  vertices.find(query.position(), [&](Index vertex) {
    Candidate candidate{surface.triangle_of_vertex[vertex], {0, 0, 0}};
    const Triangle& triangle = surface.triangles[candidate.triangle];
    candidate.barycentric[static_cast<std::size_t>(
        std::find(triangle.begin(), triangle.end(), vertex) - triangle.begin())] = 1;
    describe(query, limits, candidate);
    const Index first = surface.first_vertex[surface.mesh_of_vertex(vertex)];
    candidate.same_number = candidate.same_region && vertex - first == query.number();
    if (best.triangle == kNone || is_better(candidate, best)) best = candidate;
    return false;
  });
  return best;
}

Candidate SurfaceSearch::Tree::nearest(const Query& query, const MatchLimits& limits) const {
  ClosestTriangles closest{surface, Eigen::Vector3d(query.position()), kTie * surface.diagonal, {}};
  Eigen::BVMinimize(boxes(), closest);
  // In the order of the triangles, so that the order in which they were found does not matter.
  std::erase_if(closest.found, [&](const Candidate& candidate) {
    return candidate.distance > closest.least + closest.tie;
  });
  std::sort(closest.found.begin(), closest.found.end(),
            [](const Candidate& a, const Candidate& b) { return a.triangle < b.triangle; });
  Candidate best;
  for (Candidate& candidate : closest.found) {
    describe(query, limits, candidate);
    if (best.triangle == kNone || is_better(candidate, best)) best = candidate;
  }
  return best;
}

SurfaceSearch::SurfaceSearch(const BindSurface& surface, std::span<const Index> triangles)
    : tree_(std::make_unique<Tree>(surface, triangles)) {}

SurfaceSearch::SurfaceSearch(const BindSurface& surface) {
  std::vector<Index> all(surface.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  tree_ = std::make_unique<Tree>(surface, all);
}

SurfaceSearch::~SurfaceSearch() = default;
SurfaceSearch::SurfaceSearch(SurfaceSearch&&) noexcept = default;
SurfaceSearch& SurfaceSearch::operator=(SurfaceSearch&&) noexcept = default;

SurfaceMatch SurfaceSearch::closest(const BindSurface& of, Index vertex,
                                    const MatchLimits& limits) const {
  const BindSurface& surface = tree_->surface;
  const Query query{of, vertex};
  Candidate best = tree_->coincident(query, limits);
  const bool is_vertex = best.triangle != kNone;
  if (!is_vertex) best = tree_->nearest(query, limits);
  SurfaceMatch match;
  if (best.triangle == kNone) return match;
  match.mesh = surface.mesh_of_triangle(best.triangle);
  match.triangle = best.triangle - surface.first_triangle[match.mesh];
  match.barycentric = best.barycentric;
  match.distance = best.distance;
  match.cosine = best.cosine;
  const bool is_near = best.distance <= limits.distance && best.cosine >= limits.cosine;
  const bool is_on_surface = best.distance <= kMatchOnSurface * surface.diagonal &&
                             (is_vertex || best.cosine >= kRoughlyAgrees);
  match.is_accepted = is_near || is_on_surface;
  return match;
}

std::vector<SurfacePlace> SurfaceSearch::within(const Vec3d& point, double distance) const {
  NearTriangles near{tree_->surface, Eigen::Vector3d(point), distance, {}};
  Eigen::BVIntersect(tree_->boxes(), near);
  std::ranges::sort(near.found, {}, &SurfacePlace::triangle);
  return std::move(near.found);
}

MatchCounts count_matches(std::span<const SurfaceMatch> matches, const MatchLimits& limits) {
  MatchCounts counts;
  for (const SurfaceMatch& match : matches) {
    if (match.mesh == kNone)
      ++counts.impossible;
    else if (match.is_accepted)
      ++counts.accepted;
    else
      ++(match.distance > limits.distance ? counts.too_far : counts.turned_away);
    if (match.is_accepted && match.distance == 0 && std::ranges::count(match.barycentric, 1.0) == 1)
      ++counts.coincident;
  }
  return counts;
}

SurfaceMatches match_surfaces(const BindSurface& from, const BindSurface& to,
                              const MatchLimits& limits) {
  const SurfaceSearch search(to);
  SurfaceMatches result;
  result.first_vertex = from.first_vertex;
  result.matches.reserve(from.positions.size());
  for (Index v = 0; v < from.vertex_count(); ++v)
    result.matches.push_back(search.closest(from, v, limits));
  result.counts = count_matches(result.matches, limits);
  return result;
}

}  // namespace sunder::validation
