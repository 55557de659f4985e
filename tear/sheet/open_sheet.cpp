#include "tear/sheet/open_sheet.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "tear/internal/surface.h"
#include "tear/path/imprint_point.h"
#include "tear/sheet/faces_near.h"
#include "tear/sheet/imprint_sheets.h"
#include "tear/sheet/section_corners.h"
#include "tear/sheet/walk_sheet.h"
#include "tear/surface/sort_by_index.h"

namespace sunder::tear {
namespace {

/// Removes duplicate edges, and edges along which the surface only touches the sheet: those have
/// its inside on both sides or on neither. The rest is sorted.
void drop_touching(ScratchVector<PointEdge>& edges) {
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  ScratchVector<PointEdge> kept(edges.get_allocator());
  kept.reserve(edges.size());
  for (const PointEdge& edge : edges)
    if (!std::binary_search(edges.begin(), edges.end(), PointEdge{edge[1], edge[0]}))
      kept.push_back(edge);
  edges = std::move(kept);
}

/// Calls visit(run) with each run of edges: open ones first, then closed ones.
/// @param edges  sorted, each once.
template <class Visit>
void for_each_run(const ScratchVector<PointEdge>& edges, Visit visit) {
  ScratchVector<Index> arrivals(edges.get_allocator());
  arrivals.reserve(edges.size());
  for (const PointEdge& edge : edges) arrivals.push_back(edge[1]);
  std::sort(arrivals.begin(), arrivals.end());
  ScratchVector<bool> is_taken(edges.size(), false, edges.get_allocator());
  ScratchVector<PointEdge> run(edges.get_allocator());
  run.reserve(edges.size() + 1);
  const auto follow = [&](std::size_t first) {
    run.clear();
    for (std::size_t i = first; i != edges.size();) {
      is_taken[i] = true;
      run.push_back(edges[i]);
      const Index end = edges[i][1];
      auto next = static_cast<std::size_t>(
          std::lower_bound(edges.begin(), edges.end(), PointEdge{end, 0}) - edges.begin());
      while (next < edges.size() && edges[next][0] == end && is_taken[next]) ++next;
      i = next < edges.size() && edges[next][0] == end ? next : edges.size();
    }
    visit(run);
  };
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (!is_taken[i] && !std::binary_search(arrivals.begin(), arrivals.end(), edges[i][0]))
      follow(i);
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (!is_taken[i]) follow(i);
}

}  // namespace

ScratchVector<Index> faces_across(const Sheet& sheet, const SurfaceEditor& editor,
                                  PosedPoints& posed) {
  const Surface& surface = editor.surface();
  posed.compare_with(sheet.plane);
  ScratchVector<Index> faces(&editor.scratch());
  const auto add = [&](Index face) {
    const Index* const points = &surface.corner_point[3 * std::size_t{face}];
    const bool is_inside = posed.is_inside(editor, points[0]);
    if (posed.is_inside(editor, points[1]) == is_inside &&
        posed.is_inside(editor, points[2]) == is_inside &&
        std::count_if(points, points + 3,
                      [&](Index point) { return posed.is_on_plane(editor, point); }) < 2)
      return;
    const auto has_corner_in = [&](const Sheet::Bound& bound) {
      return std::any_of(points, points + 3, [&](Index point) {
        return bound.side.contains(posed.position(editor, point));
      });
    };
    if (std::all_of(sheet.bounds.begin(), sheet.bounds.end(), has_corner_in)) faces.push_back(face);
  };
  const ScratchVector<Index> near = faces_near(sheet, editor, posed);
  faces.reserve(near.size());
  for (const Index face : near) add(face);
  sort_by_index(
      faces, [](Index face) { return face; }, editor.scratch());
  return faces;
}

namespace {

/// The faces of the stage that were split from some faces, which are ascending, and those
/// themselves.
ScratchVector<Index> with_parts(const ScratchVector<Index>& faces, const SurfaceEditor& editor) {
  ScratchVector<Index> all(faces, &editor.scratch());
  const Index end = editor.surface().triangle_count();
  for (Index t = editor.stage.first_triangle(); t < end; ++t)
    if (std::binary_search(faces.begin(), faces.end(), editor.stage.ancestor(t))) all.push_back(t);
  return all;
}

/// A single edge between two tips stays closed at both ends, so it gets another point that can
/// open. @return false if that fails.
bool make_openable(ScratchVector<PointEdge>& run, const Workpiece& work) {
  SurfaceEditor& editor = work.editor;
  if (run.size() != 1 || editor.surface().is_on_border(run[0][0]) ||
      editor.surface().is_on_border(run[0][1]))
    return true;
  const Index h = editor.surface().find_half_edge(run[0][0], run[0][1]);
  const Index middle = h == kNone ? kNone : split_posed_edge(h, 0.5, editor, work.posed);
  if (middle == kNone) return false;
  run.push_back({middle, run[0][1]});
  run[0][1] = middle;
  return true;
}

/// Imprints what the walk left over, and orders all edges in runs.
/// @param walked  the edges that it made.
void imprint_rest(const Sheet& sheet, std::span<const Index> faces,
                  std::span<const PointEdge> walked, const Workpiece& work, SheetOpening& opening) {
  const SheetImprint imprint = imprint_sheets({&sheet, 1}, faces, work.editor, work.posed);
  opening.faces_crossed += imprint.faces_crossed;
  opening.blocked += imprint.blocked;
  ScratchVector<PointEdge> edges(&work.editor.scratch());
  edges.reserve(imprint.edges[0].size() + walked.size());
  edges.assign(imprint.edges[0].begin(), imprint.edges[0].end());
  edges.insert(edges.end(), walked.begin(), walked.end());
  drop_touching(edges);
  opening.edges.reserve(edges.size());
  for_each_run(edges, [&](ScratchVector<PointEdge>& run) {
    if (!make_openable(run, work)) {
      ++opening.blocked;
      return;
    }
    ++opening.runs;
    opening.edges.insert(opening.edges.end(), run.begin(), run.end());
  });
}

void note_borders(std::span<const Index> half_edges, std::span<const SectionCorner> section_corners,
                  const Surface& surface, SheetOpening& opening) {
  ScratchVector<Index> left_of_edge(opening.edges.size(), kNone, opening.left.get_allocator());
  opening.left.reserve(opening.edges.size());
  opening.right.reserve(opening.edges.size());
  for (std::size_t i = 0; i < opening.edges.size(); ++i) {
    const auto& [from, to] = opening.edges[i];
    const Index known = i < half_edges.size() ? half_edges[i] : kNone;
    const bool is_right = known != kNone && surface.corner_point[known] == from &&
                          surface.corner_point[Surface::next(known)] == to;
    const Index left = is_right ? known : surface.find_half_edge(from, to);
    const Index right = left == kNone ? kNone : surface.twin[left];
    if (right == kNone) continue;
    opening.left.push_back(left);
    opening.right.push_back(right);
    left_of_edge[i] = left;
  }
  for (const SectionCorner& corner : section_corners) {
    const Index arriving = left_of_edge[corner.arriving], leaving = left_of_edge[corner.leaving];
    if (arriving == kNone || leaving == kNone) continue;
    opening.left_following.push_back({arriving, leaving});
    opening.right_following.push_back({surface.twin[leaving], surface.twin[arriving]});
  }
  std::sort(opening.left_following.begin(), opening.left_following.end());
  std::sort(opening.right_following.begin(), opening.right_following.end());
}

}  // namespace

SheetOpening open_sheet(const Sheet& sheet, std::span<const Index> faces, bool keeps_borders,
                        const Workpiece& work, std::vector<LipPair>& lips) {
  SurfaceEditor& editor = work.editor;
  PosedPoints& posed = work.posed;
  SheetOpening opening{ScratchVector<PointEdge>(&editor.scratch()),
                       ScratchVector<Index>(&editor.scratch()),
                       ScratchVector<Index>(&editor.scratch()),
                       ScratchVector<std::array<Index, 2>>(&editor.scratch()),
                       ScratchVector<std::array<Index, 2>>(&editor.scratch())};
  ScratchVector<SectionCorner> section_corners(&editor.scratch());
  std::span<const Index> half_edges;
  SheetWalk walk(sheet.plane, editor, posed);
  if (sheet.bounds.empty()) {
    walk.cross(faces);
    opening.faces_crossed = walk.faces_crossed();
  }
  if (!sheet.bounds.empty()) {
    imprint_rest(sheet, faces, {}, work, opening);
  } else if (!walk.are_runs_whole()) {
    const ScratchVector<Index> rest = with_parts(walk.left_over(), editor);
    imprint_rest(sheet, rest, walk.edges(), work, opening);
  } else {
    opening.runs = walk.run_count();
    opening.edges = walk.edges();
    half_edges = walk.half_edges();
  }
  for (const auto& [from, to] : opening.edges)
    opening.length_posed += norm(posed.position(editor, to) - posed.position(editor, from));
  if (keeps_borders) {
    if (half_edges.empty())
      section_corners = find_section_corners(opening.edges, sheet.plane.normal, editor, posed);
    note_borders(half_edges, section_corners, editor.surface(), opening);
  }
  const std::size_t first_lip = lips.size();
  open_edges(opening.edges, half_edges, section_corners, editor, lips);
  for (std::size_t i = first_lip; i < lips.size(); ++i)
    posed.pin(lips[i].left, Vec3d(posed.position(editor, lips[i].right)));
  return opening;
}

}  // namespace sunder::tear
