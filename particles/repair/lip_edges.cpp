#include "particles/repair/lip_edges.h"

#include <cmath>

#include "core/internal/ordered.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// Writes edges of lips.
class LipEdges {
 public:
  explicit LipEdges(StructureEdit& edit)
      : edit_(edit),
        border_(edit.border()),
        surface_(edit.surface()),
        points_(edit.structure().points),
        lips_(edit.structure().lips) {}

  /// Removes the edge that leaves a point.
  void forget(Index point) {
    const Index edge = points_.lip_points[point].edge;
    if (edge == kNone || lips_[edge].points[0] == lips_[edge].points[1]) return;
    if (edge < edit_.change().lips) edit_.change().changed_lips.emplace_back(edge, lips_[edge]);
    lips_[edge] = {{point, point}, Vec3f::Zero()};
  }

  /// Stores the border edges at a point that belong to a lip, or to the rim of a bore, which is new
  /// all around.
  void renew(Index point) {
    const Index leaving = border_.leaving(point), arriving = border_.arriving(point);
    if (leaving == kNone || arriving == kNone) return;
    const Index to = surface_.corner_point[Surface::next(leaving)],
                from = surface_.corner_point[arriving];
    if (is_torn(point) && is_torn(to)) keep(leaving);
    if ((is_torn(point) && is_torn(from)) || points_.lip_points[from].edge != kNone) keep(arriving);
    const LipPoint& own = points_.lip_points[point];
    const Index beyond = own.tear != kNone && !is_torn(to) ? border_.leaving(to)
                                                           : kNone;  // where the other lip begins
    if (beyond == kNone) return;
    const LipPoint& other = points_.lip_points[surface_.corner_point[Surface::next(beyond)]];
    if (other.tear != own.tear || other.side == own.side) return;
    keep(leaving);
    keep(beyond);
  }

  /// Stores the border edges at a point, and forgets the one that left it and is none any more.
  void revise(Index point) {
    const Index leaving = border_.leaving(point), arriving = border_.arriving(point);
    if (leaving == kNone || edit_.structure().character.border.has(leaving, edit_.model()))
      forget(point);
    else
      keep(leaving);
    if (arriving != kNone) keep(arriving);
  }

 private:
  [[nodiscard]] bool is_torn(Index point) const {
    return points_.lip_points[point].tear != kNone || point >= edit_.first_new_point();
  }

  /// Length of a half-edge times its conormal, into the face.
  [[nodiscard]] Vec3f inward(Index half_edge) const {
    const Vec3f& at = points_.positions[surface_.corner_point[half_edge]];
    const Vec3f& to = points_.positions[surface_.corner_point[Surface::next(half_edge)]];
    const Vec3f& across = points_.positions[surface_.corner_point[Surface::previous(half_edge)]];
    const Vec3f edge = to - at;
    const float squared = squared_norm(edge);
    Vec3f inward = Vec3f::Zero();
    if (squared > 0) inward = (across - at) - dot(across - at, edge) / squared * edge;
    const float length = norm(inward);
    if (length > 0) inward *= std::sqrt(squared) / length;
    return inward;
  }

  /// Stores a border half-edge as an edge of a lip, in place of the edge that left its first point.
  /// A tear that leaves a border of the source and comes in again leaves a part of it between two
  /// points of its lips.
  void keep(Index half_edge) {
    if (edit_.structure().character.border.has(half_edge, edit_.model())) return;
    const Index a = surface_.corner_point[half_edge],
                b = surface_.corner_point[Surface::next(half_edge)];
    LipPoint& lip = points_.lip_points[a];
    if (lip.edge != kNone) {
      if (lips_[lip.edge].points[1] == b) return;
      forget(a);
    }
    edit_.log_point(a);
    lip.edge = static_cast<Index>(lips_.size());
    lips_.push_back({{a, b}, inward(half_edge)});
  }

  StructureEdit& edit_;
  const LipBorder& border_;
  const Surface& surface_;
  PointTable& points_;
  std::vector<LipEdge>& lips_;
};

}  // namespace

void renew_lip_edges(StructureEdit& edit, std::span<const Index> lips,
                     std::span<const Index> lost) {
  LipEdges edges(edit);
  for (const Index point : lost) edges.forget(point);
  for (const Index point : lips) edges.renew(point);
  const PointTable& points = edit.structure().points;
  const bool has_lips = !lips.empty();  // new points on lips of the tear are among them
  for (Index point = edit.first_new_point(); point < points.count(); ++point)
    if (edit.surface().point_corner[point] != kNone &&
        !(has_lips && points.lip_points[point].tear == edit.tear()))
      edges.renew(point);
}

void revise_lip_edges(StructureEdit& edit, Index point) { LipEdges(edit).revise(point); }

}  // namespace sunder::particles
