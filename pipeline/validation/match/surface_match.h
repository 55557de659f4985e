#pragma once

#include <sunder/tear/torn_model.h>

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "pipeline/validation/match/bind_surface.h"

namespace sunder::validation {

/// A place on a face of a surface.
struct SurfacePlace {
  Index triangle = kNone;                           ///< Of all.
  std::array<double, 3> barycentric = {1.0, 0, 0};  ///< >= 0, sum 1.
};

/// The place on one surface that belongs to a vertex of another.
struct SurfaceMatch {
  Index mesh = kNone;      ///< Of the surface searched; kNone: it has no triangle with an area.
  Index triangle = kNone;  ///< Of that mesh.
  std::array<double, 3> barycentric = {1.0, 0, 0};  ///< >= 0, sum 1.
  double distance = 0;                              ///< Metres.
  double cosine = 1;  ///< Between the normals; 1 where one of them has none.
  bool is_accepted = false;
};

/// A match is accepted if it is near enough and its normal agrees. Places on the surface (within
/// 1e-6 of its diagonal) are accepted up to 60 degrees, vertices at one place always.
struct MatchLimits {
  double distance = 0;       ///< Largest, metres.
  double cosine = -1;        ///< Smallest.
  bool either_side = false;  ///< Whether opposite normals agree too.
};

struct MatchCounts {
  Index coincident = 0;  ///< Same place as a vertex of the surface searched; accepted.
  Index accepted = 0;
  Index too_far = 0;
  Index turned_away = 0;  ///< Near enough, but the normals disagree.
  Index impossible = 0;   ///< Nothing to be matched to.
};

/// One match per vertex of a surface, all meshes one after the other.
struct SurfaceMatches {
  std::vector<Index> first_vertex = {0};  ///< Per mesh, and the end.
  std::vector<SurfaceMatch> matches;
  MatchCounts counts;

  [[nodiscard]] const SurfaceMatch& of(Index mesh, Index vertex) const {
    return matches[first_vertex[mesh] + vertex];
  }
};

/// Finds the closest places on a surface. A vertex at the very place is found by a hash table, all
/// else by a tree of boxes (Eigen's KdBVH). Places that are equally close (within 2e-7 of the
/// diagonal) are told apart by roughly agreeing normals (60 degrees, or the limit), the same tear
/// side, the same number in the same region, the same region, clearly better agreeing normals, and
/// last by the smallest triangle, so that the result does not depend on the order of the search.
/// Reentrant.
class SurfaceSearch {
 public:
  /// @param surface    outlives the search.
  /// @param triangles  the part that is searched; those without area are left out.
  /// O(n log n), allocates.
  SurfaceSearch(const BindSurface& surface, std::span<const Index> triangles);
  /// All triangles.
  explicit SurfaceSearch(const BindSurface& surface);
  ~SurfaceSearch();
  SurfaceSearch(SurfaceSearch&&) noexcept;
  SurfaceSearch& operator=(SurfaceSearch&&) noexcept;

  /// The closest place to a vertex of another surface. A few microseconds; allocates the queue of
  /// the search.
  [[nodiscard]] SurfaceMatch closest(const BindSurface& of, Index vertex,
                                     const MatchLimits& limits) const;
  /// Per triangle that comes so near to a point: its closest place, ascending by triangle.
  [[nodiscard]] std::vector<SurfacePlace> within(const Vec3d& point, double distance) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// The closest place on `to` for each vertex of `from`. Call it both ways round: from the target to
/// the source shows what was added, from the source to the target what is missing.
[[nodiscard]] SurfaceMatches match_surfaces(const BindSurface& from, const BindSurface& to,
                                            const MatchLimits& limits);

/// The same for a torn model on its source, exactly: by the births of its vertices. Vertices inside
/// walls and caps do not lie on the source and have no match.
[[nodiscard]] SurfaceMatches matches_from_births(const TornModel& model);

/// Counts the outcomes again, after matches were changed.
[[nodiscard]] MatchCounts count_matches(std::span<const SurfaceMatch> matches,
                                        const MatchLimits& limits);

}  // namespace sunder::validation
