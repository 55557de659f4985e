#include "tear/operation/drill.h"

#include <cmath>

#include "core/internal/ordered.h"
#include "tear/filling/walls.h"
#include "tear/geometry/tolerances.h"
#include "tear/sheet/gap.h"
#include "tear/surface/improve.h"

namespace sunder::tear {
namespace {

constexpr std::size_t kMostSides = 1536;

/// Unit vectors to the corners of a regular polygon whose sides come within `tolerance` (a fraction
/// of the radius) of the circle: a hexagon whose arcs are halved until they do. Uses only square
/// roots and sums, so that every mathematical library gives the same bits.
std::vector<Vec3d> circle_corners(const Vec3d& x, const Vec3d& y, double tolerance) {
  const double half_root = 0.5 * std::sqrt(3.0);
  std::vector<Vec3d> corners = {x, 0.5 * x + half_root * y, -0.5 * x + half_root * y};
  for (std::size_t i = 0; i < 3; ++i) corners.push_back(-corners[i]);
  while (1 - norm(0.5 * (corners[0] + corners[1])) > tolerance &&
         2 * corners.size() <= kMostSides) {
    std::vector<Vec3d> finer;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3d between = corners[i] + corners[(i + 1) % corners.size()];
      finer.push_back(corners[i]);
      finer.push_back(between / norm(between));
    }
    corners = std::move(finer);
  }
  return corners;
}

/// The sides of the prism, then its two ends.
Cell cell_of(const Bore& bore) {
  const Vec3d axis = bore.direction / norm(bore.direction);
  const Vec3d away = std::abs(axis.x()) < 0.5 ? Vec3d(Vec3d::UnitX()) : Vec3d(Vec3d::UnitY());
  const Vec3d across = axis.cross(away);
  const Vec3d x = across / norm(across), y = axis.cross(x);
  const auto corners =
      circle_corners(x, y, bore.chord_tolerance > 0 ? bore.chord_tolerance / bore.radius : 0.01);
  Cell cell;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    Vec3d inward = -(a + b);
    inward /= norm(inward);
    cell.push_back({inward, dot(inward, bore.origin + bore.radius * a)});
  }
  cell.push_back({axis, dot(axis, bore.origin)});
  cell.push_back({-axis, -(dot(axis, bore.origin) + bore.depth)});
  return cell;
}

}  // namespace

Status validate_bore(const Bore& bore) {
  if (!bore.origin.allFinite() || !bore.direction.allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone,
                           "the axis of the bore is not finite");
  if (bore.origin.cwiseAbs().maxCoeff() > kFarthestMetres ||
      bore.direction.cwiseAbs().maxCoeff() > kFarthestMetres)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the axis of the bore lies beyond 1e60");
  if (!(norm(bore.direction) > kShortestDirection))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the direction of the bore has no length");
  if (!(bore.radius > kShortestMetres && bore.radius <= kLongestMetres))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the radius of the bore is %g; it must be above 0 and at most 1e30",
                           bore.radius);
  if (!(bore.depth > kShortestMetres && bore.depth <= kLongestMetres))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the depth of the bore is %g; it must be above 0 and at most 1e30",
                           bore.depth);
  if (!(bore.chord_tolerance >= 0 && bore.chord_tolerance <= bore.radius))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the chord tolerance is %g; it must be from 0 to the radius",
                           bore.chord_tolerance);
  return {};
}

void drill_surface(const Bore& bore, const Workpiece& work, Outcome& outcome) {
  TearReport& report = outcome.report;
  const EditLog::Mark before = work.editor.mark();
  const Cell cell = cell_of(bore);
  const GapRemoval removal =
      remove_cell(cell, faces_in_cell(cell, work.editor, work.posed), work.editor, work.posed);
  report.runs = removal.faces_removed > 0 ? 1 : 0;
  report.faces_crossed = removal.faces_crossed;
  report.blocked = removal.blocked;
  report.area_removed_posed = removal.area_posed;
  improve_faces(before, work.editor);
  if (bore.wall)
    report.open_sections = add_bore_wall(work.editor.opened_edges.borders(), bore.origin,
                                         bore.direction / norm(bore.direction), bore.depth, work);
}

}  // namespace sunder::tear
