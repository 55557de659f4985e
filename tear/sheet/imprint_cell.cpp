#include "tear/sheet/imprint_cell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/path/snapping.h"
#include "tear/sheet/face_lines.h"
#include "tear/surface/flip_edge.h"
#include "tear/surface/line_splitter.h"
#include "tear/surface/sort_by_index.h"
#include "tear/surface/split.h"

namespace sunder::tear {
namespace {

using Word = CellSides::Word;

/// Number of crossed edges for which there is room at first.
constexpr std::size_t kEdges = 64;

/// The place where the plane of a side crosses an edge. The edge has the direction of its lower
/// half-edge, so that both faces compute the same numbers.
struct Crossing {
  Index side = kNone;
  double fraction = 0;
  Vec3d position = Vec3d::Zero();
  /// Distance along the edge per distance from the plane. The greater it is, the less precise is
  /// the crossing.
  double slant = 1;
  Index point = kNone;  ///< Set when the crossing is imprinted.
  bool is_new = false;  ///< Whether the point was made for this crossing.
};

/// An edge with crossings in the cell.
struct CrossedEdge {
  Index half_edge = kNone;
  Index begin = 0, end = 0;  ///< Its crossings, ascending by side.
  /// Its ends and stored_part() before any edge was split, because splitting one edge changes
  /// half-edges.
  Index from = kNone, to = kNone;
  double stored = 0;
  std::array<Index, 2> faces = {kNone, kNone};  ///< The crossed faces on its sides, by number.
  bool is_split = false;
};

/// A face as it was before any edge was split.
struct Face {
  Index triangle = kNone;
  std::array<Index, 3> points = {};
  std::array<Index, 3> edges = {};       ///< The half-edges, or their twins if those are lower.
  std::array<bool, 3> is_reversed = {};  ///< Whether the edge runs against the face's half-edge.
  /// Index in the crossed edges; kNone for an edge without a crossing in the cell.
  std::array<Index, 3> crossed = {kNone, kNone, kNone};
  CellSides::Places places = {};
};

/// One end of a line in a face: at a crossing of one of its edges, or at a corner where the plane
/// meets another side.
struct LineEnd {
  Vec3d position = Vec3d::Zero();
  Index crossed_edge = kNone;  ///< Edge of the face: 0, 1, 2.
  Index other_side = kNone;
};

/// The part of a side's plane in a face, directed so that the inside is on the left.
struct Line {
  Index side = kNone;
  LineEnd from, to;
};

/// The children of faces since a stage began, in lists that are completed when they are asked for.
class Children {
 public:
  explicit Children(const SurfaceEditor& editor)
      : editor_(editor),
        first_(editor.stage.first_triangle()),
        newest_(0, editor.scratch()),
        older_(&editor.scratch()) {}

  /// Pairs (face, child), ascending, without the face itself. Valid until the next call.
  [[nodiscard]] std::span<const std::array<Index, 2>> of(Index face,
                                                         ScratchVector<std::array<Index, 2>>& list);

 private:
  const SurfaceEditor& editor_;
  Index first_;
  IndexMap newest_;             ///< Per face: index in lists_.
  ScratchVector<Index> older_;  ///< Per new triangle: the child of the same face before it.
  ScratchVector<Index> lists_{&editor_.scratch()};       ///< Per list: its newest child.
  Index newest_ancestor_ = kNone, newest_list_ = kNone;  ///< Of the last triangle.
};

std::span<const std::array<Index, 2>> Children::of(Index face,
                                                   ScratchVector<std::array<Index, 2>>& list) {
  const Index end = editor_.surface().triangle_count();
  for (Index t = first_ + static_cast<Index>(older_.size()); t < end; ++t) {
    const Index ancestor = editor_.stage.ancestor(t);
    if (ancestor != newest_ancestor_) {  // most children follow one another
      newest_ancestor_ = ancestor;
      const auto fresh = static_cast<Index>(lists_.size());
      const Index known = newest_.insert(ancestor, fresh);
      newest_list_ = known == kNone ? fresh : known;
      if (known == kNone) lists_.push_back(kNone);
    }
    older_.push_back(lists_[newest_list_]);
    lists_[newest_list_] = t;
  }
  list.clear();
  const Index known = newest_.find(face);
  for (Index t = known == kNone ? kNone : lists_[known]; t != kNone; t = older_[t - first_])
    list.push_back({face, t});
  std::reverse(list.begin(), list.end());
  return list;
}

class Imprint {
 public:
  Imprint(CellSides& sides, SurfaceEditor& editor)
      : sides_(sides),
        editor_(editor),
        posed_(sides.posed()),
        faces_(&editor.scratch()),
        crossings_(&editor.scratch()),
        edges_(&editor.scratch()),
        edge_at_(kEdges, editor.scratch()),
        lines_(&editor.scratch()) {}

  CellImprint run(std::span<const CellFace> faces) {
    editor_.stage.begin();
    faces_.reserve(faces.size());
    crossings_.reserve(2 * faces.size());
    edges_.reserve(2 * faces.size());
    for (const CellFace& face : faces) add_face(face);
    split_edges();
    Children children(editor_);
    for (const Face& face : faces_) draw_lines(face, children);
    return result_;
  }

 private:
  [[nodiscard]] const PlaneSide& side(Index number) const { return sides_.cell()[number]; }

  void add_face(const CellFace& added) {
    if (added.is_inside) return;
    const Index triangle = added.face;
    const CellSides::OfFace of = sides_.at(added.places);
    if (sides_.is_beyond(of)) return;
    Word crossed = 0;
    for (Index w = 0; w < sides_.word_count(); ++w) crossed |= of.crossed(w);
    if (crossed == 0) return;
    const Surface& surface = editor_.surface();
    Face& face = faces_.emplace_back();
    face.triangle = triangle;
    face.places = added.places;
    for (Index k = 0; k < 3; ++k) {
      const Index h = 3 * triangle + k, twin = surface.twin[h];
      face.points[k] = surface.corner_point[h];
      face.edges[k] = std::min(h, twin);  // kNone is the highest
      face.is_reversed[k] = twin < h;
    }
    for (Index k = 0; k < 3; ++k) {
      face.crossed[k] = add_edge(face, of, k);
      if (face.crossed[k] == kNone) continue;
      auto& faces = edges_[face.crossed[k]].faces;
      faces[faces[0] == kNone ? 0 : 1] = static_cast<Index>(faces_.size() - 1);
    }
  }

  /// Adds the crossings of edge k of a face, unless the face across it has added them.
  /// @return the index of the edge; kNone if it has no crossings.
  Index add_edge(const Face& face, const CellSides::OfFace& of, Index k) {
    Word crossed = 0;
    for (Index w = 0; w < sides_.word_count(); ++w)
      crossed |= of.outside[k][w] ^ of.outside[(k + 1) % 3][w];
    if (crossed == 0) return kNone;
    if (const Index known = edge_at_.find(face.edges[k]); known != kNone) return known;
    CrossedEdge edge;
    edge.half_edge = face.edges[k];
    edge.begin = static_cast<Index>(crossings_.size());
    for (Index w = 0; w < sides_.word_count(); ++w)
      CellSides::for_each_bit(of.outside[k][w] ^ of.outside[(k + 1) % 3][w], w, [&](Index side) {
        const Crossing crossing = cross(face, k, side);
        if (is_in_cell(of, k, crossing)) crossings_.push_back(crossing);
      });
    edge.end = static_cast<Index>(crossings_.size());
    if (edge.begin == edge.end) return kNone;
    const auto number = static_cast<Index>(edges_.size());
    edge_at_.insert(edge.half_edge, number);
    edge.from = editor_.surface().corner_point[edge.half_edge];
    edge.to = editor_.surface().corner_point[Surface::next(edge.half_edge)];
    edge.stored = stored_part(edge.half_edge, editor_);
    edges_.push_back(edge);
    return number;
  }

  /// The crossing of edge k of a face with the plane of a side that has its ends on both sides.
  Crossing cross(const Face& face, Index k, Index number) {
    const Index from = face.is_reversed[k] ? (k + 1) % 3 : k,
                to = face.is_reversed[k] ? k : (k + 1) % 3;
    const Vec3d &at_from = sides_.position(face.places[from]),
                &at_to = sides_.position(face.places[to]);
    const PlaneSide& plane = side(number);
    const double value_from = plane.value(at_from), value_to = plane.value(at_to);
    const double fraction =
        value_from == value_to ? 0.0 : std::clamp(value_from / (value_from - value_to), 0.0, 1.0);
    const double slant = norm(at_to - at_from) / std::max(std::abs(value_from - value_to),
                                                          std::numeric_limits<double>::min());
    return {number, fraction, at_from + fraction * (at_to - at_from), slant, kNone, false};
  }

  /// Whether the other sides contain a crossing of edge k of a face. Those that contain both ends
  /// of the edge do.
  [[nodiscard]] bool is_in_cell(const CellSides::OfFace& of, Index k,
                                const Crossing& crossing) const {
    const Index l = (k + 1) % 3;
    for (Index w = 0; w < sides_.word_count(); ++w) {
      bool is_inside = (of.outside[k][w] & of.outside[l][w]) == 0;
      const Word doubtful = ~(of.inside[k][w] & of.inside[l][w]) & sides_.all(w);
      if (is_inside)
        CellSides::for_each_bit(doubtful, w, [&](Index other) {
          is_inside =
              is_inside && (other == crossing.side || side(other).contains(crossing.position));
        });
      if (!is_inside) return false;
    }
    return true;
  }

  /// Splits the edges in the order of their half-edges.
  void split_edges() {
    ScratchVector<std::array<Index, 2>> order(&editor_.scratch());  // half-edge, edge
    order.reserve(edges_.size());
    for (Index i = 0; i < edges_.size(); ++i) order.push_back({edges_[i].half_edge, i});
    sort_by_index(
        order, [](const auto& of) { return of[0]; }, editor_.scratch());
    ScratchVector<Crossing*> along(&editor_.scratch());
    for (const auto& [half_edge, number] : order) {
      CrossedEdge& edge = edges_[number];
      if (edge.is_split) continue;
      if (is_plain(edge)) {
        split_from(edge);
        continue;
      }
      along.clear();
      for (Index i = edge.begin; i < edge.end; ++i) along.push_back(&crossings_[i]);
      if (along.size() > 1)
        std::sort(along.begin(), along.end(), [](const Crossing* a, const Crossing* b) {
          return a->fraction != b->fraction ? a->fraction < b->fraction : a->side < b->side;
        });
      split_edge(edge, along);
    }
  }

  /// Whether an edge is crossed once, away from its ends.
  [[nodiscard]] bool is_plain(const CrossedEdge& edge) const {
    if (edge.end - edge.begin != 1) return false;
    const Crossing& crossing = crossings_[edge.begin];
    const double snap = std::max(kSnapEdges, edge.stored * crossing.slant);
    return crossing.fraction > snap && crossing.fraction < 1 - snap;
  }

  /// Splits a plain edge and, one after the other, the faces beyond that need no closer look: whole
  /// triangles of the source with one line, from one plain edge to another.
  void split_from(CrossedEdge& edge) {
    const Surface& surface = editor_.surface();
    Crossing& first = crossings_[edge.begin];
    Index h = edge.half_edge;
    if (surface.corner_point[h] != edge.from || surface.corner_point[Surface::next(h)] != edge.to)
      h = surface.find_half_edge(edge.from, edge.to);
    LineSplitter splitter(editor_);
    const Index made = h == kNone ? kNone : splitter.begin(h, first.fraction);
    if (made == kNone) {
      split_edge(edge, std::array{&first});
      return;
    }
    set_point(edge, made);
    const CrossedEdge* last = &edge;
    while (CrossedEdge* const next = edge_after(*last, splitter)) last = next;
    splitter.end();
  }

  void set_point(CrossedEdge& edge, Index point) {
    Crossing& crossing = crossings_[edge.begin];
    posed_.pin(point, crossing.position);
    crossing.point = point;
    crossing.is_new = true;
    edge.is_split = true;
  }

  /// Crosses the face ahead of an edge that was just split. @return the edge that is split now;
  /// null if the face needs a closer look.
  CrossedEdge* edge_after(const CrossedEdge& last, LineSplitter& splitter) {
    if (splitter.ahead() == kNone || !editor_.origins.is_whole(splitter.ahead() / 3))
      return nullptr;
    const auto is_ahead = [&](Index number) {
      return number != kNone && faces_[number].triangle == splitter.ahead() / 3;
    };
    if (!is_ahead(last.faces[0]) && !is_ahead(last.faces[1])) return nullptr;
    const Face& face = faces_[last.faces[is_ahead(last.faces[0]) ? 0 : 1]];
    Index exit = kNone;
    for (Index k = 0; k < 3; ++k) {
      if (face.crossed[k] == kNone || &edges_[face.crossed[k]] == &last) continue;
      if (exit != kNone) return nullptr;
      exit = k;
    }
    if (exit == kNone) return nullptr;
    CrossedEdge& next = edges_[face.crossed[exit]];
    const Crossing& crossing = crossings_[next.begin];
    if (next.is_split || !is_plain(next) || crossing.side != crossings_[last.begin].side)
      return nullptr;
    const Index made =
        splitter.go_on(3 * face.triangle + exit,
                       face.is_reversed[exit] ? 1 - crossing.fraction : crossing.fraction);
    if (made == kNone) return nullptr;
    set_point(next, made);
    return &next;
  }

  void split_edge(const CrossedEdge& edge, std::span<Crossing* const> along) {
    const Index to = edge.to;
    Index last = edge.from;
    double last_fraction = 0;
    for (Crossing* crossing : along) {
      const double snap =
          std::min(kFarthestSnapEdges,
                   edge.stored * crossing->slant);  // ends nearer than this are stored on the plane
      if (crossing->fraction - last_fraction <= snap) {
        crossing->point = last;
      } else if (crossing->fraction >= 1 - snap) {
        crossing->point = to;
      } else {
        const double fraction = (crossing->fraction - last_fraction) / (1 - last_fraction);
        const Index point = split_between(last, to, fraction, edge.half_edge);
        if (point == kNone) {
          // The faces are too small for another point. An end nearby is used instead; one that is
          // far off is not on the line, and the crossing is blocked.
          const double near = std::max(kSnapEdges, 4 * snap);
          if (fraction <= near || fraction >= 1 - near)
            crossing->point = fraction < 0.5 ? last : to;
          else
            crossing->point = turn_to_crossing(edge, last, fraction);
          continue;
        }
        posed_.pin(point, crossing->position);
        crossing->point = last = point;
        crossing->is_new = true;
        last_fraction = crossing->fraction;
      }
    }
  }

  /// Where a sliver is as narrow as positions are stored, the crossing of its one long side is
  /// stored as that of the other. The edge is turned, so that it goes through that point.
  /// @param from  the begin of what is left of the edge.
  /// @param fraction  the crossing between `from` and the end of the edge.
  /// @return the point; kNone if there is none, or the edge cannot be turned.
  Index turn_to_crossing(const CrossedEdge& edge, Index from, double fraction) {
    const Surface& surface = editor_.surface();
    Index half_edge = surface.find_half_edge(from, edge.to);
    if (half_edge == kNone) {
      half_edge = surface.find_half_edge(edge.to, from);
      fraction = 1 - fraction;
    }
    // Between faces that the cell does not both cross, its lines would not meet.
    if (half_edge == kNone || surface.twin[half_edge] == kNone || edge.faces[1] == kNone ||
        !editor_.origins.is_inner_edge(half_edge))
      return kNone;
    const Index mesh = surface.triangle(half_edge / 3).mesh;
    const auto bind = [&](Index corner) {
      return Vec3d(
          editor_.births.position(mesh, editor_.vertex_at(corner)).template cast<double>());
    };
    const Vec3d begin = bind(half_edge),
                at = begin + fraction * (bind(Surface::next(half_edge)) - begin);
    double least = kStoredCoordinates * at.cwiseAbs().maxCoeff();
    Index point = kNone;
    for (const Index side : {half_edge, surface.twin[half_edge]}) {
      const Index corner = Surface::previous(side);
      const double away = norm(Vec3d(bind(corner) - at));
      if (away > least) continue;
      least = away;
      point = surface.corner_point[corner];
    }
    if (point == kNone || !flip_edge(half_edge, editor_)) return kNone;
    result_.has_turned_edges = true;
    return point;
  }

  /// @param likely  a half-edge that may be the one from `from` to `to`.
  Index split_between(Index from, Index to, double fraction, Index likely) {
    const Surface& surface = editor_.surface();
    if (surface.corner_point[likely] == from && surface.corner_point[Surface::next(likely)] == to)
      return tear::split_edge(likely, fraction, editor_);
    if (const Index h = surface.find_half_edge(from, to); h != kNone)
      return tear::split_edge(h, fraction, editor_);
    if (const Index h = surface.find_half_edge(to, from); h != kNone)
      return tear::split_edge(h, 1 - fraction, editor_);
    return kNone;
  }

  /// The crossing of edge k of a face with the plane of a side; null if it is not in the cell.
  [[nodiscard]] const Crossing* crossing_at(const Face& face, Index k, Index side) const {
    if (face.crossed[k] == kNone) return nullptr;
    const CrossedEdge& edge = edges_[face.crossed[k]];
    for (Index i = edge.begin; i < edge.end; ++i)
      if (crossings_[i].side == side) return &crossings_[i];
    return nullptr;
  }

  /// The part of a side's plane in a face that lies in the cell.
  bool find_line(const Face& face, const CellSides::OfFace& of, Index number, Line& line) {
    line.side = number;
    const auto contains = [&](Index k) {
      return ((of.outside[k % 3][number / CellSides::kBits] >> (number % CellSides::kBits)) & 1) ==
             0;
    };
    Index leaving = 0, entering = 0;
    for (Index k = 0; k < 3; ++k) {
      if (contains(k) && !contains(k + 1)) leaving = k;
      if (!contains(k) && contains(k + 1)) entering = k;
    }
    const Crossing* const from = crossing_at(face, leaving, number);
    const Crossing* const to = crossing_at(face, entering, number);
    if (from != nullptr && to != nullptr) {  // both in the cell, and so is what is between them
      line.from = {from->position, leaving, kNone};
      line.to = {to->position, entering, kNone};
      return true;
    }
    line.from = {cross(face, leaving, number).position, leaving, kNone};
    line.to = {cross(face, entering, number).position, entering, kNone};
    return clip(line);
  }

  /// Clips a line by the other sides. @return whether anything is left.
  bool clip(Line& line) const {
    ClippedLine clipped{line.from.position, line.to.position - line.from.position};
    for (Index i = 0; i < sides_.cell().size(); ++i) {
      if (i == line.side) continue;
      switch (clipped.clip(side(i))) {
        case ClippedLine::Change::none: break;
        case ClippedLine::Change::all: return false;
        case ClippedLine::Change::first:
          line.from = {clipped.place(clipped.first), kNone, i};
          break;
        case ClippedLine::Change::last: line.to = {clipped.place(clipped.last), kNone, i}; break;
      }
    }
    return clipped.first < clipped.last;
  }

  /// A corner in a face where two sides meet; the lines of both end in it.
  struct MetCorner {
    std::array<Index, 2> sides;
    Index point;
  };

  Index point_of(const LineEnd& end, const Face& face, Index side, FaceLines& lines,
                 ScratchVector<MetCorner>& corners) {
    if (end.other_side == kNone) {
      const Crossing* const crossing = crossing_at(face, end.crossed_edge, side);
      return crossing == nullptr ? kNone : crossing->point;
    }
    const std::array<Index, 2> met = {std::min(side, end.other_side),
                                      std::max(side, end.other_side)};
    for (const MetCorner& corner : corners)
      if (corner.sides == met) return corner.point;
    return corners.emplace_back(MetCorner{met, lines.imprint(end.position)}).point;
  }

  /// Whether the lines in a face are edges already: where one side splits two of its edges once
  /// each, the second split ends in the point of the first.
  [[nodiscard]] bool is_drawn(const Face& face) const {
    Index edges = 0, side = kNone;
    for (const Index number : face.crossed) {
      if (number == kNone) continue;
      const CrossedEdge& edge = edges_[number];
      const Crossing& crossing = crossings_[edge.begin];
      if (edge.end - edge.begin != 1 || !crossing.is_new) return false;
      if (edges++ > 0 && crossing.side != side) return false;
      side = crossing.side;
    }
    return edges == 2;
  }

  void draw_lines(const Face& face, Children& children) {
    if (is_drawn(face)) {
      ++result_.faces_crossed;
      return;
    }
    const CellSides::OfFace of = sides_.at(face.places);
    lines_.clear();
    for (Index w = 0; w < sides_.word_count(); ++w)
      CellSides::for_each_bit(of.crossed(w), w, [&](Index side) {
        if (!find_line(face, of, side, lines_.emplace_back())) lines_.pop_back();
      });
    if (lines_.empty()) return;
    ++result_.faces_crossed;
    ScratchVector<std::array<Index, 2>> list(&editor_.scratch());
    FaceLines drawn(face.triangle, face.points, children.of(face.triangle, list), editor_, posed_);
    ScratchVector<MetCorner> corners(&editor_.scratch());
    bool is_blocked = false;
    for (const Line& line : lines_) {
      const Index first = point_of(line.from, face, line.side, drawn, corners),
                  last = point_of(line.to, face, line.side, drawn, corners);
      if (first == kNone || last == kNone || !drawn.draw(first, last)) is_blocked = true;
    }
    result_.blocked += is_blocked ? 1 : 0;
  }

  CellSides& sides_;
  SurfaceEditor& editor_;
  PosedPoints& posed_;
  ScratchVector<Face> faces_;
  ScratchVector<Crossing> crossings_;  ///< Edge by edge.
  ScratchVector<CrossedEdge> edges_;
  IndexMap edge_at_;           ///< Per half-edge of a crossed edge: index in edges_.
  ScratchVector<Line> lines_;  ///< Of the face that is drawn.
  CellImprint result_;
};

}  // namespace

CellImprint imprint_cell(CellSides& sides, std::span<const CellFace> faces, SurfaceEditor& editor) {
  return Imprint(sides, editor).run(faces);
}

}  // namespace sunder::tear
