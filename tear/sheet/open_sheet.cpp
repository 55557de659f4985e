#include "tear/sheet/open_sheet.h"

#include <algorithm>
#include <map>

#include "core/internal/ordered.h"
#include "tear/internal/surface.h"
#include "tear/path/imprint_point.h"
#include "tear/sheet/imprint_sheets.h"

namespace sunder::tear {
namespace {

/// Removes duplicate edges, and edges along which the surface only touches the sheet: those have
/// its inside on both sides or on neither.
void drop_touching(std::vector<PointEdge>& edges) {
  std::vector<PointEdge> sorted = edges;
  std::sort(sorted.begin(), sorted.end());
  std::vector<PointEdge> kept;
  for (const PointEdge& edge : edges)
    if (!std::binary_search(sorted.begin(), sorted.end(), PointEdge{edge[1], edge[0]}))
      kept.push_back(edge);
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  edges = std::move(kept);
}

/// Chains edges into runs.
std::vector<std::vector<PointEdge>> runs_of(const std::vector<PointEdge>& edges) {
  std::map<Index, std::vector<std::size_t>> leaving;
  std::map<Index, Index> arriving;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    leaving[edges[i][0]].push_back(i);
    ++arriving[edges[i][1]];
  }
  std::vector<bool> is_taken(edges.size(), false);
  std::vector<std::vector<PointEdge>> runs;
  const auto follow = [&](std::size_t first) {
    std::vector<PointEdge>& run = runs.emplace_back();
    for (std::size_t i = first; i != edges.size();) {
      is_taken[i] = true;
      run.push_back(edges[i]);
      const auto next = leaving.find(edges[i][1]);
      i = edges.size();
      if (next == leaving.end()) break;
      for (const std::size_t candidate : next->second)
        if (!is_taken[candidate]) i = std::min(i, candidate);
    }
  };
  for (std::size_t i = 0; i < edges.size(); ++i)  // open runs first, then closed ones
    if (!is_taken[i] && arriving.find(edges[i][0]) == arriving.end()) follow(i);
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (!is_taken[i]) follow(i);
  return runs;
}

}  // namespace

std::vector<Index> faces_across(const Sheet& sheet, const SurfaceEditor& editor,
                                PosedPoints& posed) {
  const Surface& surface = editor.surface();
  const Frame frame = posed.frame_along(
      axes_along(sheet.plane.normal,
                 sheet.bounds.empty() ? Vec3d(Vec3d::Zero()) : sheet.bounds[0].side.normal),
      editor);
  std::vector<FramedPlaneSide> sides = {{frame, sheet.plane},
                                        {frame, {-sheet.plane.normal, -sheet.plane.offset}}};
  for (const Sheet::Bound& bound : sheet.bounds) sides.emplace_back(frame, bound.side);
  const auto may_meet = [&](const FrameBox& box) {
    return std::none_of(sides.begin(), sides.end(),
                        [&](const FramedPlaneSide& side) { return side.is_beside(box); });
  };
  std::vector<Index> faces;
  posed.for_each_face(editor, frame, may_meet, [&](Index face) {
    std::array<Vec3d, 3> corners;
    for (Index k = 0; k < 3; ++k)
      corners[k] = posed.position(editor, surface.corner_point[3 * face + k]);
    const auto has_corner_in = [&](const PlaneSide& side) {
      return std::any_of(corners.begin(), corners.end(),
                         [&](const Vec3d& corner) { return side.contains(corner); });
    };
    const bool is_across = has_corner_in(sheet.plane) &&
                           std::any_of(corners.begin(), corners.end(), [&](const Vec3d& corner) {
                             return !sheet.plane.contains(corner);
                           });
    if (is_across &&
        std::all_of(sheet.bounds.begin(), sheet.bounds.end(),
                    [&](const Sheet::Bound& bound) { return has_corner_in(bound.side); }))
      faces.push_back(face);
  });
  std::sort(faces.begin(), faces.end());
  return faces;
}

SheetOpening open_sheet(const Sheet& sheet, std::span<const Index> faces, const Workpiece& work,
                        std::vector<LipPair>& lips) {
  SurfaceEditor& editor = work.editor;
  PosedPoints& posed = work.posed;
  SheetImprint imprint = imprint_sheets({&sheet, 1}, faces, editor, posed);
  SheetOpening opening;
  opening.faces_crossed = imprint.faces_crossed;
  opening.blocked = imprint.blocked;
  drop_touching(imprint.edges[0]);
  for (std::vector<PointEdge>& run : runs_of(imprint.edges[0])) {
    // A single edge between two tips stays closed at both ends, so it needs another point that can
    // open.
    if (run.size() == 1 && !editor.surface().is_on_border(run[0][0]) &&
        !editor.surface().is_on_border(run[0][1])) {
      const Index h = editor.surface().find_half_edge(run[0][0], run[0][1]);
      const Index middle = h == kNone ? kNone : split_posed_edge(h, 0.5, editor, posed);
      if (middle == kNone) {
        ++opening.blocked;
        continue;
      }
      run = {{run[0][0], middle}, {middle, run[0][1]}};
    }
    ++opening.runs;
    for (const PointEdge& edge : run) {
      opening.length_posed +=
          norm(posed.position(editor, edge[1]) - posed.position(editor, edge[0]));
      opening.edges.push_back(edge);
    }
  }
  for (const auto& [from, to] : opening.edges) {
    const Index left = editor.surface().find_half_edge(from, to);
    const Index right = left == kNone ? kNone : editor.surface().twin[left];
    if (right == kNone) continue;
    opening.left.push_back(left);
    opening.right.push_back(right);
  }
  const std::size_t first_lip = lips.size();
  open_edges(opening.edges, {}, editor, lips);
  for (std::size_t i = first_lip; i < lips.size(); ++i)
    posed.pin(lips[i].left, Vec3d(posed.position(editor, lips[i].right)));
  return opening;
}

}  // namespace sunder::tear
