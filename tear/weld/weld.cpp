#include "tear/weld/weld.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "core/operation/internal/check_ranges.h"
#include "core/operation/internal/describe_operations.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/mesh_vertices.h"
#include "tear/sheet/remove_faces.h"
#include "tear/surface/disjoint_sets.h"
#include "tear/surface/join_edges.h"
#include "tear/surface/open.h"
#include "tear/surface/split.h"
#include "tear/weld/choose_lips.h"
#include "tear/weld/fillings_at_lips.h"

namespace sunder::tear {
namespace {

/// Two lips that are going to be one edge.
struct LipsToJoin {
  Lip a, b;
};

/// The lips that are welded, by their ends, which no split of another lip changes. Ascending.
using ChosenEdges = ScratchVector<PointEdge>;

/// Gives a lip the points at which others lie on it end.
/// @param shares  descending.
void split_lip(const Lip& lip, std::span<const double> shares, SurfaceEditor& editor,
               Outcome& outcome, ChosenEdges& chosen) {
  PointEdge rest = lip.points;
  double length = 1;  // of the part that is left
  for (const double share : shares) {
    const Index h = editor.surface().find_half_edge(rest[0], rest[1]);
    const Index made = h == kNone ? kNone : split_edge(h, share / length, editor);
    if (made == kNone) {
      ++outcome.report.blocked;
      continue;
    }
    chosen.push_back({made, rest[1]});
    rest[1] = made;
    length = share;
  }
  chosen.push_back(rest);
}

/// Chooses lips, and splits them where one has a point that the other one lacks.
ChosenEdges choose_and_split(const Weld& weld, const Workpiece& work, Outcome& outcome) {
  ScratchMemory& scratch = work.editor.scratch();
  const ScratchVector<Lip> lips = find_lips(work.editor);
  const ScratchVector<LipOverlap> overlaps = find_overlaps(lips, scratch);
  const ScratchVector<bool> is_chosen =
      choose_lips({weld.places, weld.reach}, lips, overlaps, work);
  ScratchVector<ScratchVector<double>> shares(&scratch);
  shares.resize(lips.size());
  for (const LipOverlap& of : overlaps) {
    if (of.is_whole || !is_chosen[of.a] || !is_chosen[of.b]) continue;
    add_shares_between(lips[of.a], lips[of.b], shares[of.a]);
    add_shares_between(lips[of.b], lips[of.a], shares[of.b]);
  }
  ChosenEdges chosen(&scratch);
  for (Index i = 0; i < lips.size(); ++i)
    if (is_chosen[i]) split_lip(lips[i], shares[i], work.editor, outcome, chosen);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// Pairs of lips with the same ends that are wanted, in the order of their half-edges.
template <class IsWanted>
ScratchVector<LipsToJoin> pair_lips(SurfaceEditor& editor, IsWanted is_wanted) {
  const ScratchVector<Lip> lips = find_lips(editor);
  ScratchVector<LipsToJoin> pairs(&editor.scratch());
  for (const LipOverlap& of : find_overlaps(lips, editor.scratch()))
    if (of.is_whole && is_wanted(lips[of.a], lips[of.b])) pairs.push_back({lips[of.a], lips[of.b]});
  std::sort(pairs.begin(), pairs.end(), [](const LipsToJoin& a, const LipsToJoin& b) {
    return std::min(a.a.half_edge, a.b.half_edge) < std::min(b.a.half_edge, b.b.half_edge);
  });
  return pairs;
}

bool is_one_surface_point(Index a, Index b, const SurfaceEditor& editor) {
  const VertexRef of_a = editor.vertex_ref_at(a), of_b = editor.vertex_ref_at(b);
  const auto& meshes = editor.character().meshes;
  return editor.surface().corner_point[a] == editor.surface().corner_point[b] ||
         is_same_surface_point(meshes[of_a.mesh], of_a.vertex, meshes[of_b.mesh], of_b.vertex);
}

/// The end of a lip: a corner, and its place on the lip's line.
struct LipEnd {
  const Lip& lip;
  Index corner;
  const std::array<double, 2>& place;
};

/// Where another wound crosses two lips, each has a point of its own there. Moves one of them to
/// the other. @return whether they are at one place now.
bool bring_together(const LipEnd& a, const LipEnd& b, SurfaceEditor& editor) {
  if (is_one_surface_point(a.corner, b.corner, editor)) return true;
  return move_border_point(b.corner, place_in_origin(b.lip, a.place, editor),
                           editor.vertex_ref_at(a.corner), editor) ||
         move_border_point(a.corner, place_in_origin(a.lip, b.place, editor),
                           editor.vertex_ref_at(b.corner), editor);
}

/// @return false if they cannot be joined; then nothing is changed.
bool join_lips(const LipsToJoin& pair, SurfaceEditor& editor) {
  const auto& [a, b] = pair;
  const std::vector<Index>& twin = editor.surface().twin;
  if (twin[a.half_edge] != kNone || twin[b.half_edge] != kNone) return false;
  const Index after_a = Surface::next(a.half_edge), after_b = Surface::next(b.half_edge);
  if (is_one_surface_point(a.half_edge, after_b, editor) &&
      is_one_surface_point(after_a, b.half_edge, editor))
    return join_edges(a.half_edge, b.half_edge, editor);
  const EditLog::Mark before = editor.mark();
  const bool is_joined = bring_together({a, a.half_edge, a.from}, {b, after_b, b.to}, editor) &&
                         bring_together({a, after_a, a.to}, {b, b.half_edge, b.from}, editor) &&
                         join_edges(a.half_edge, b.half_edge, editor);
  if (!is_joined) editor.roll_back(before);
  return is_joined;
}

/// Removes what fills wounds, and joins their lips.
/// @param joined  appended: a half-edge of each edge.
void join_all(const ScratchVector<LipsToJoin>& pairs, const Workpiece& work, Outcome& outcome,
              ScratchVector<Index>& joined) {
  SurfaceEditor& editor = work.editor;
  ScratchVector<Index> half_edges(&editor.scratch());
  for (const LipsToJoin& pair : pairs)
    for (const Index h : {pair.a.half_edge, pair.b.half_edge}) half_edges.push_back(h);
  if (const auto faces = fillings_at_lips(half_edges, editor); !faces.empty())
    RemovedFaces(faces, editor).remove(editor, work.posed);
  const auto is_removed = [&](const Lip& lip) {
    return editor.surface().has_repeated_point(lip.half_edge / 3);
  };
  for (const LipsToJoin& pair : pairs) {
    if (is_removed(pair.a) || is_removed(pair.b)) continue;  // a torn wall that went
    if (join_lips(pair, editor))
      joined.push_back(std::min(pair.a.half_edge, pair.b.half_edge));
    else
      ++outcome.report.blocked;
  }
}

/// Open edges that run to and fro between two points, of which a weld joined one at least: the
/// arrays cannot tell such an edge from a closed one, so it is closed too. Its sides may be skin
/// and the wall of a bore, which are no partners.
ScratchVector<LipsToJoin> single_edges_between(std::span<const Index> joined,
                                               SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  ScratchVector<Index> welded(&editor.scratch());
  for (const Index h : joined)
    for (const Index corner : {h, Surface::next(h)}) welded.push_back(surface.corner_point[corner]);
  std::sort(welded.begin(), welded.end());
  const auto is_welded = [&](Index point) {
    return std::binary_search(welded.begin(), welded.end(), point);
  };
  ScratchVector<Lip> open(&editor.scratch());
  for_each_open_half_edge(editor, [&](Index h) {
    Lip lip;
    lip.half_edge = h;
    lip.points = {surface.corner_point[h], surface.corner_point[Surface::next(h)]};
    if (is_welded(lip.points[0]) || is_welded(lip.points[1])) open.push_back(lip);
  });
  const auto before = [](const Lip& a, const Lip& b) { return a.points < b.points; };
  std::sort(open.begin(), open.end(), [](const Lip& a, const Lip& b) {
    return a.points != b.points ? a.points < b.points : a.half_edge < b.half_edge;
  });
  ScratchVector<LipsToJoin> pairs(&editor.scratch());
  for (const Lip& lip : open) {
    if (lip.points[0] > lip.points[1]) continue;
    Lip back;
    back.points = {lip.points[1], lip.points[0]};
    const auto at = std::lower_bound(open.begin(), open.end(), back, before);
    if (at != open.end() && at->points == back.points) pairs.push_back({lip, *at});
  }
  return pairs;
}

/// The number of connected runs of edges.
Index count_joined_runs(std::span<const Index> half_edges, const SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  ScratchVector<std::array<Index, 2>> ends(&editor.scratch());  // point, edge
  for (Index i = 0; i < half_edges.size(); ++i) {
    ends.push_back({surface.corner_point[half_edges[i]], i});
    ends.push_back({surface.corner_point[Surface::next(half_edges[i])], i});
  }
  std::sort(ends.begin(), ends.end());
  DisjointSets runs(static_cast<Index>(half_edges.size()), editor.scratch());
  auto count = static_cast<Index>(half_edges.size());
  for (std::size_t i = 1; i < ends.size(); ++i)
    if (ends[i][0] == ends[i - 1][0] && runs.unite(ends[i - 1][1], ends[i][1])) --count;
  return count;
}

double posed_length_of(std::span<const Index> half_edges, const Workpiece& work) {
  const Surface& surface = work.editor.surface();
  work.posed.cover(surface.point_count());
  double length = 0;
  for (const Index h : half_edges) {
    const Vec3d from = work.posed.position(work.editor, surface.corner_point[h]);
    length += norm(
        Vec3d(work.posed.position(work.editor, surface.corner_point[Surface::next(h)]) - from));
  }
  return length;
}

}  // namespace

Status validate_weld(const Weld& weld) {
  if (Status status = ChosenWounds{weld.places, weld.reach}.validate("weld"); !status)
    return status;
  return check_ranges(weld);
}

void weld_surface(const Weld& weld, const Workpiece& work, Outcome& outcome) {
  SurfaceEditor& editor = work.editor;
  const EditLog::Mark before = editor.mark();
  const ChosenEdges chosen = choose_and_split(weld, work, outcome);
  ScratchVector<Index> joined(&editor.scratch());
  join_all(pair_lips(editor,
                     [&](const Lip& a, const Lip& b) {
                       return std::binary_search(chosen.begin(), chosen.end(), a.points) &&
                              std::binary_search(chosen.begin(), chosen.end(), b.points);
                     }),
           work, outcome, joined);
  if (joined.empty()) {
    editor.roll_back(before);
    work.posed.forget_from(before.points);
    return;
  }
  join_all(single_edges_between(joined, editor), work, outcome, joined);
  keep_scars(joined, editor);
  outcome.report.runs = count_joined_runs(joined, editor);
  outcome.report.length_posed = posed_length_of(joined, work);
}

}  // namespace sunder::tear
