#include "pipeline/validation/transfer/regions.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <map>
#include <utility>

#include "core/internal/bone_sides.h"
#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"
#include "pipeline/validation/match/bone_match.h"

namespace sunder::validation {
namespace {

/// Searches over parts and sides of the source, made when they are first asked for.
class RegionSearches {
 public:
  RegionSearches(const BindSurface& source, const MatchRegions& regions)
      : source_(source), regions_(regions) {}

  /// @param part  kNone: all parts.
  const SurfaceSearch& of(Index part, int side) {
    auto& search = searches_[{part, side}];
    if (search == nullptr) search = std::make_unique<SurfaceSearch>(source_, triangles(part, side));
    return *search;
  }

 private:
  /// All of the part if nothing of it is on that side.
  [[nodiscard]] std::vector<Index> triangles(Index part, int side) const {
    std::vector<Index> of_part, of_side;
    for (Index t = 0; t < source_.triangles.size(); ++t) {
      if (part != kNone && regions_.source_part[t] != part) continue;
      of_part.push_back(t);
      if (side == 0 || regions_.source_side[t] != -side) of_side.push_back(t);
    }
    return of_side.empty() ? of_part : of_side;
  }

  const BindSurface& source_;
  const MatchRegions& regions_;
  std::map<std::pair<Index, int>, std::unique_ptr<SurfaceSearch>> searches_;
};

/// The part of the source for each part of the target: where most accepted matches are; where none
/// is accepted, most matches.
std::vector<Index> choose_parts(const BindSurface& source, const MatchRegions& regions,
                                std::span<const SurfaceMatch> matches) {
  std::map<Index, std::map<Index, std::pair<Index, Index>>> votes;  // accepted, all
  Index parts = 0;
  for (std::size_t v = 0; v < matches.size(); ++v) {
    parts = std::max(parts, regions.target_part[v] + 1);
    if (matches[v].mesh == kNone) continue;
    const Index triangle = source.first_triangle[matches[v].mesh] + matches[v].triangle;
    auto& [accepted, all] = votes[regions.target_part[v]][regions.source_part[triangle]];
    accepted += matches[v].is_accepted ? 1 : 0;
    ++all;
  }
  std::vector<Index> chosen(parts, kNone);
  for (const auto& [part, of_part] : votes)
    chosen[part] =
        std::ranges::max_element(of_part, {}, [](const auto& vote) { return vote.second; })->first;
  return chosen;
}

}  // namespace

int SidePlane::side_of(const Vec3d& position, double band) const {
  const double height = dot(normal, position - point);
  return height > band ? 1 : height < -band ? -1 : 0;
}

std::optional<SidePlane> find_side_plane(const Character& character) {
  const ModelPose bind = or_throw(bind_pose(character));
  const std::vector<Index> mirrored = mirrored_bones(character.skeleton);
  SidePlane plane;
  double count = 0;
  for (Index left = 0; left < mirrored.size(); ++left) {
    if (mirrored[left] == kNone || side_of_name(character.skeleton.bones[left].name) > 0) continue;
    const Vec3d at_left = bind.model_from_bone[left].translation(),
                at_right = bind.model_from_bone[mirrored[left]].translation();
    plane.normal += at_right - at_left;
    plane.point += (at_left + at_right) / 2;
    ++count;
  }
  if (count == 0 || !(norm(plane.normal) > 0)) return std::nullopt;
  plane.normal = normalized(plane.normal);
  plane.point /= count;
  return plane;
}

SurfaceMatches match_in_regions(const BindSurface& target, const BindSurface& source,
                                const MatchLimits& limits, const MatchRegions& regions) {
  RegionSearches searches(source, regions);
  SurfaceMatches result;
  result.first_vertex = target.first_vertex;
  result.matches.resize(target.positions.size());
  const auto side_of = [&](Index v) {
    return regions.target_side.empty() ? 0 : regions.target_side[v];
  };
  for (Index v = 0; v < target.vertex_count(); ++v)
    result.matches[v] = searches.of(kNone, side_of(v)).closest(target, v, limits);
  if (!regions.target_part.empty()) {
    const std::vector<Index> chosen = choose_parts(source, regions, result.matches);
    for (Index v = 0; v < target.vertex_count(); ++v) {
      const Index part = chosen[regions.target_part[v]];
      if (part != kNone)
        result.matches[v] = searches.of(part, side_of(v)).closest(target, v, limits);
    }
  }
  result.counts = count_matches(result.matches, limits);
  return result;
}

}  // namespace sunder::validation
