#include "tear/operation/nearest_layer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/path/imprint.h"
#include "tear/path/imprint_point.h"
#include "tear/path/wall_path.h"
#include "tear/surface/open.h"

namespace sunder::tear {
namespace {

/// A sweep that gets nowhere this many times in a segment gives up.
constexpr int kMostFutileVisits = 64;

/// One segment of a stroke on its way.
class NearestLayerSegment {
 public:
  NearestLayerSegment(const BladePlane& plane, const Workpiece& work, StrokeTip& tip,
                      Outcome& outcome)
      : plane_(plane), work_(work), tip_(tip), outcome_(outcome) {}

  void tear();

 private:
  /// How far along the segment a piece reaches, in [0, 1].
  struct Reached {
    double progress;
    bool has_edges;  ///< New lips, or a way along older ones.
  };
  Reached tear_piece(Index start, const EditLog::Mark& before);
  void make_openable(Path& path);
  void add_walls(Path& path);
  double take_back(const Path& path, Index start, bool continues, const EditLog::Mark& before);
  void open(const Path& path);

  const BladePlane& plane_;
  const Workpiece& work_;
  StrokeTip& tip_;
  Outcome& outcome_;
  Index last_end_ = kNone;  ///< Where the last piece of the segment ended.
  /// Where a lip with a wall was crossed, if the last piece ended there. It may have snapped to a
  /// point beyond.
  std::optional<double> lip_progress_;
  bool has_torn_ = false;
};

/// Imprints and opens one piece of the path, from a point to where the blade, the surface or the
/// faces end. Moves the tip.
NearestLayerSegment::Reached NearestLayerSegment::tear_piece(Index start,
                                                             const EditLog::Mark& before) {
  Path path = imprint_path(plane_, start, work_.editor, work_.posed);
  const bool continues = start == tip_.point && tip_.ends_run;
  tip_.point = kNone;
  if (path.end == PathEnd::blocked) ++outcome_.report.blocked;
  make_openable(path);
  // Where the last piece of this segment snapped, something of the section may be left next to it:
  // not a piece of its own.
  const bool is_leftover = path.points.back() == last_end_;
  if (path.points.size() < 2 || is_leftover)
    return {take_back(path, start, continues, before), false};
  if (path.is_along_lip && path.end != PathEnd::blade)
    return {take_back(path, start, continues, before), true};
  last_end_ = path.points.back();
  if (!path.is_along_lip) {
    if (!path.is_on_wall) add_walls(path);
    open(path);
    outcome_.report.faces_crossed += path.faces_crossed;
    outcome_.report.length_posed += path.length_posed;
  }
  if (!continues) ++outcome_.report.runs;
  if (path.end != PathEnd::blade) return {path.progress, true};
  // At a lip the next segment may begin on the other side, on a wall at a lip above.
  if (path.is_on_wall || path.points.back() != last_end_) return {1.0, true};
  tip_.point = last_end_;
  tip_.ends_run = true;
  return {1.0, true};
}

/// A tear of one edge between two tips would be closed at both ends of its only edge: it gets a
/// point in the middle, which can open.
void NearestLayerSegment::make_openable(Path& path) {
  const Surface& surface = work_.editor.surface();
  if (path.points.size() != 2 || path.is_along_lip || surface.is_on_border(path.points[0]) ||
      surface.is_on_border(path.points[1]))
    return;
  const Index edge = surface.find_half_edge(path.points[0], path.points[1]);
  const Index middle = split_posed_edge(edge, 0.5, work_.editor, work_.posed);
  if (middle == kNone)
    path.points.pop_back();
  else
    path.points.insert(path.points.begin() + 1, middle);
  path.half_edges.clear();
}

/// Extends a piece down the walls of the lips at which it begins or ends.
void NearestLayerSegment::add_walls(Path& path) {
  const Surface& surface = work_.editor.surface();
  const auto below = [&](Index point) {
    return surface.is_on_border(point) ? ScratchVector<Index>(&work_.editor.scratch())
                                       : imprint_wall(plane_, point, work_.editor, work_.posed);
  };
  const ScratchVector<Index> first = below(path.points.front());
  path.points.insert(path.points.begin(), first.rbegin(), first.rend());
  if (!first.empty()) path.half_edges.clear();
  if (path.end == PathEnd::blocked) return;
  const ScratchVector<Index> last = below(path.points.back());
  if (last.empty()) return;
  path.points.insert(path.points.end(), last.begin(), last.end());
  path.half_edges.clear();
  lip_progress_ = path.crossing_progress;
}

/// Undoes the imprint of a piece that has no edge. A blade that moved by less than the resolution
/// continues from the same point.
double NearestLayerSegment::take_back(const Path& path, Index start, bool continues,
                                      const EditLog::Mark& before) {
  work_.editor.roll_back(before);
  work_.posed.forget_from(before.points);
  if (path.end != PathEnd::blade) return path.progress;
  if (start < before.points) {
    tip_.point = start;
    tip_.ends_run = continues;
  }
  return 1.0;
}

/// Opens the edges of a piece. Both lips stay where the path was found until the pose changes.
void NearestLayerSegment::open(const Path& path) {
  SurfaceEditor& editor = work_.editor;
  ScratchVector<PointEdge> edges(&editor.scratch());
  edges.reserve(path.points.size() - 1);
  for (std::size_t i = 0; i + 1 < path.points.size(); ++i)
    edges.push_back({path.points[i], path.points[i + 1]});
  std::vector<LipPair>& lips = outcome_.borders.lips;
  const std::size_t first_lip = lips.size();
  open_edges(edges, path.half_edges, {}, editor, lips);
  for (std::size_t i = first_lip; i < lips.size(); ++i)
    work_.posed.pin(lips[i].left, Vec3d(work_.posed.position(editor, lips[i].right)));
  has_torn_ = true;
}

/// Where the surface ends, folds away or cannot be split, the sweep continues on the next surface
/// that it meets. Every iteration passes at least one triangle.
void NearestLayerSegment::tear() {
  double progress = 0;
  if (tip_.point != kNone)
    progress = std::max(0.0, tear_piece(tip_.point, work_.editor.mark()).progress);
  for (int futile = 0; progress < 1 && futile < kMostFutileVisits;) {
    auto contact = find_contact(plane_, progress, work_, tip_);
    if (!contact) break;
    if (const auto lip = std::exchange(lip_progress_, std::nullopt); lip && *lip < progress)
      if (const auto before =
              contact_in(contact->triangle, plane_, *lip, work_.editor, work_.posed))
        contact = before;
    const EditLog::Mark before = work_.editor.mark();
    const Index start = imprint_point(*contact, Snapping::by_shape, work_.editor, work_.posed);
    const Reached reached = tear_piece(start, before);
    const bool has_advanced = reached.has_edges && reached.progress > progress + kSamePlaceSweeps;
    progress = std::max(progress, reached.progress);
    if (has_advanced) continue;
    progress = std::max(progress, contact->progress_beyond);
    ++futile;
  }
  if (!has_torn_ && tip_.point == kNone) ++outcome_.report.segments_missed;
}

}  // namespace

void tear_nearest_layer(const BladePlane& plane, const Workpiece& work, StrokeTip& tip,
                        Outcome& outcome) {
  NearestLayerSegment(plane, work, tip, outcome).tear();
}

}  // namespace sunder::tear
