#include "tear/sheet/sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/surface/disjoint_sets.h"

namespace sunder::tear {
namespace {

/// The line in which a sheet meets a face.
struct SectionLine {
  double weight = 0;  ///< Of the wanted bones, the mean of both ends.
  std::array<Vec3d, 2> ends = {Vec3d(Vec3d::Zero()), Vec3d(Vec3d::Zero())};
  bool is_empty = true;    ///< The bounds exclude all of it.
  bool is_beside = false;  ///< The face has none: the plane meets it only in its edges.
};

/// Where the plane crosses the edges of a face. The edge is read in the direction of its lower
/// half-edge, so that both faces compute the same place.
class SectionedEdges {
 public:
  SectionedEdges(const Sheet& sheet, const SurfaceEditor& editor, PosedPoints& posed)
      : sheet_(sheet), surface_(editor.surface()), editor_(editor), posed_(posed) {}

  /// @return whether the plane crosses the edge of a half-edge.
  /// @param weight  the weight of the bones there; 0 if none are wanted.
  bool cross(Index half_edge, const ScratchVector<bool>& is_wanted_bone, Vec3d& place,
             double& weight) {
    const Index twin = surface_.twin[half_edge];
    const Index h = std::min(half_edge, twin);  // kNone is the highest
    const Vec3d from = posed_.position(editor_, surface_.corner_point[h]),
                to = posed_.position(editor_, surface_.corner_point[Surface::next(h)]);
    if (sheet_.plane.contains(from) == sheet_.plane.contains(to)) return false;
    const double at_from = sheet_.plane.value(from), at_to = sheet_.plane.value(to);
    const double fraction =
        at_from == at_to ? 0.0 : std::clamp(at_from / (at_from - at_to), 0.0, 1.0);
    place = from + fraction * (to - from);
    weight = is_wanted_bone.empty() ? 0.0
                                    : (1 - fraction) * weight_at(h, is_wanted_bone) +
                                          fraction * weight_at(Surface::next(h), is_wanted_bone);
    return true;
  }

  [[nodiscard]] bool is_within_bounds(const Vec3d& place) const {
    return std::all_of(sheet_.bounds.begin(), sheet_.bounds.end(),
                       [&](const Sheet::Bound& bound) { return bound.side.contains(place); });
  }

 private:
  /// The weight of some bones at a corner.
  [[nodiscard]] double weight_at(Index corner, const ScratchVector<bool>& is_wanted_bone) const {
    const Index mesh = surface_.triangle(corner / 3).mesh;
    const Skin& skin = editor_.character().skins[editor_.character().meshes[mesh].skin];
    double weight = 0;
    for (const Influence& influence : editor_.births.influences(mesh, editor_.vertex_at(corner)))
      if (is_wanted_bone[skin.bones[influence.slot]])
        weight += static_cast<double>(influence.weight);
    return weight;
  }

  const Sheet& sheet_;
  const Surface& surface_;
  const SurfaceEditor& editor_;
  PosedPoints& posed_;
};

/// Clips a line by the bounds of its sheet.
void clip(const Sheet& sheet, SectionLine& line) {
  for (const Sheet::Bound& bound : sheet.bounds) {
    const std::array<bool, 2> is_inside = {bound.side.contains(line.ends[0]),
                                           bound.side.contains(line.ends[1])};
    if (!is_inside[0] && !is_inside[1]) {
      line.is_empty = true;
      return;
    }
    if (is_inside[0] && is_inside[1]) continue;
    const double first = bound.side.value(line.ends[0]), second = bound.side.value(line.ends[1]);
    const double fraction = first == second ? 0.0 : std::clamp(first / (first - second), 0.0, 1.0);
    line.ends[is_inside[0] ? 1 : 0] = line.ends[0] + fraction * (line.ends[1] - line.ends[0]);
  }
}

double distance(const Vec3d& place, const SectionLine& line) {
  const Vec3d along = line.ends[1] - line.ends[0], way = place - line.ends[0];
  const double squared_length = squared_norm(along);
  const double part =
      squared_length > 0 ? std::clamp(dot(way, along) / squared_length, 0.0, 1.0) : 0.0;
  return norm(way - part * along);
}

/// The sections of a sheet.
class Sections {
 public:
  Sections(const Sheet& sheet, const SectionLimits& limits, const ScratchVector<Index>& faces,
           const SurfaceEditor& editor, PosedPoints& posed)
      : lines_(faces.size(), &editor.scratch()),
        sets_(static_cast<Index>(faces.size()), editor.scratch()) {
    SectionedEdges edges(sheet, editor, posed);
    const Surface& surface = editor.surface();
    for (Index i = 0; i < faces.size(); ++i) {
      SectionLine& line = lines_[i];
      std::size_t end = 0;
      for (Index h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) {
        Vec3d place;
        double weight = 0;
        if (!edges.cross(h, limits.is_wanted_bone, place, weight)) continue;
        line.weight += 0.5 * weight;
        if (end < 2) line.ends[end++] = place;
        if (!edges.is_within_bounds(place) || surface.twin[h] == kNone) continue;
        unite(i, surface.twin[h], faces);
      }
      line.is_empty = end < 2;
      line.is_beside = line.is_empty;
      if (!line.is_empty) clip(sheet, line);
      if (!line.is_beside) continue;
      for (Index h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h)
        if (surface.twin[h] != kNone && posed.is_on_plane(editor, surface.corner_point[h]) &&
            posed.is_on_plane(editor, surface.corner_point[Surface::next(h)]))
          unite(i, surface.twin[h], faces);
    }
  }

  /// Drops the sections that the wanted bones move by half or less.
  void drop_unmoved() {
    // Weight and length.
    ScratchVector<std::array<double, 2>> sums(lines_.size(), {0, 0}, lines_.get_allocator());
    for (Index i = 0; i < lines_.size(); ++i) {
      if (lines_[i].is_empty) continue;
      const double length = norm(lines_[i].ends[1] - lines_[i].ends[0]);
      sums[sets_.find(i)][0] += length * lines_[i].weight;
      sums[sets_.find(i)][1] += length;
    }
    for (Index i = 0; i < lines_.size(); ++i) {
      const auto& [weight, length] = sums[sets_.find(i)];
      if (!(weight > 0.5 * length)) lines_[i].is_empty = true;
    }
  }

  /// Marks the sections nearest to a place.
  void choose(const Vec3d& place, ScratchVector<bool>& is_chosen) {
    double least = std::numeric_limits<double>::infinity(), farthest = 0;
    for (const SectionLine& line : lines_) {
      if (line.is_empty) continue;
      least = std::min(least, distance(place, line));
    }
    for (Index i = 0; i < lines_.size(); ++i) {
      const SectionLine& line = lines_[i];
      if (line.is_empty) continue;
      farthest = std::max(place.cwiseAbs().maxCoeff(), line.ends[0].cwiseAbs().maxCoeff());
      if (distance(place, line) <= least + kPosedCoordinates * farthest)
        is_chosen[sets_.find(i)] = true;
    }
  }

  /// Marks the sections that a ray in the plane meets first.
  void choose_first(const Vec3d& normal, const SectionRay& ray, ScratchVector<bool>& is_chosen) {
    const Vec3d in_plane = ray.direction - dot(ray.direction, normal) * normal;
    const Vec3d along = in_plane / norm(in_plane), across = normal.cross(along);
    const auto distance_to = [&](const SectionLine& line) {
      constexpr double kNowhere = std::numeric_limits<double>::infinity();
      if (line.is_empty) return kNowhere;
      const Vec3d from = line.ends[0] - ray.origin, to = line.ends[1] - ray.origin;
      const double left_of_from = dot(across, from), left_of_to = dot(across, to);
      // An end on the ray counts as left of it, so that neighbouring lines leave no gap.
      if ((left_of_from < 0) == (left_of_to < 0)) return kNowhere;
      const double part = std::clamp(left_of_from / (left_of_from - left_of_to), 0.0, 1.0);
      const double at = dot(along, Vec3d(from + part * (to - from)));
      return at < 0 ? kNowhere : at;
    };
    double least = std::numeric_limits<double>::max();
    for (const SectionLine& line : lines_) least = std::min(least, distance_to(line));
    if (least == std::numeric_limits<double>::max()) return;
    const double rounding = kPosedCoordinates * (ray.origin.cwiseAbs().maxCoeff() + least);
    for (Index i = 0; i < lines_.size(); ++i)
      if (distance_to(lines_[i]) <= least + rounding) is_chosen[sets_.find(i)] = true;
  }
  [[nodiscard]] Index section_of(Index i) { return sets_.find(i); }
  /// Per section: whether it has lines.
  [[nodiscard]] ScratchVector<bool> have_lines() {
    ScratchVector<bool> have_lines(lines_.size(), false, lines_.get_allocator());
    for (Index i = 0; i < lines_.size(); ++i)
      if (!lines_[i].is_empty) have_lines[sets_.find(i)] = true;
    return have_lines;
  }
  /// Whether a face has no line, although it is met.
  [[nodiscard]] bool is_excluded(Index i) const {
    return lines_[i].is_empty && !lines_[i].is_beside;
  }

 private:
  /// Connects a face with the one that has a half-edge, if that is among `faces`.
  void unite(Index i, Index half_edge, const ScratchVector<Index>& faces) {
    const auto other = std::lower_bound(faces.begin(), faces.end(), half_edge / 3);
    if (other != faces.end() && *other == half_edge / 3)
      sets_.unite_with_lesser(i, static_cast<Index>(other - faces.begin()));
  }

  ScratchVector<SectionLine> lines_;  ///< Per face.
  DisjointSets sets_;
};

}  // namespace

ScratchVector<Index> faces_of_sections(const Sheet& sheet, const SectionLimits& limits,
                                       ScratchVector<Index> faces, const SurfaceEditor& editor,
                                       PosedPoints& posed) {
  if (!limits.has_any()) return faces;
  Sections sections(sheet, limits, faces, editor, posed);
  if (!limits.is_wanted_bone.empty()) sections.drop_unmoved();
  const bool chooses = !limits.places.empty() || limits.first_hit;
  ScratchVector<bool> is_chosen(faces.size(), !chooses, &editor.scratch());
  for (const Vec3d& place : limits.places) sections.choose(place, is_chosen);
  if (limits.first_hit) sections.choose_first(sheet.plane.normal, *limits.first_hit, is_chosen);
  ScratchVector<Index> staying(&editor.scratch());
  staying.reserve(faces.size());
  const ScratchVector<bool> have_lines = sections.have_lines();
  for (Index i = 0; i < faces.size(); ++i)
    if (!sections.is_excluded(i) && is_chosen[sections.section_of(i)] &&
        have_lines[sections.section_of(i)])
      staying.push_back(faces[i]);
  return staying;
}

}  // namespace sunder::tear
