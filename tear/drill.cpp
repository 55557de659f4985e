#include "tear/drill.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tear/gap.h"
#include "tear/improve.h"
#include "tear/walls.h"

namespace sunder::tear {
namespace {

constexpr int kMostSides = 1024;

/// Sides of a polygon in a circle whose middles are at most `tolerance` inside it.
int side_count(double radius, double tolerance) {
  const double sagitta = std::clamp(tolerance / radius, 1e-9, 0.5);
  return std::clamp(static_cast<int>(std::ceil(std::numbers::pi / std::acos(1 - sagitta))), 6, kMostSides);
}

/// The prism, then its two ends.
Cell cell_of(const Bore& bore) {
  const Vec3d axis = bore.direction / bore.direction.norm();
  const Vec3d away = std::abs(axis.x()) < 0.5 ? Vec3d(Vec3d::UnitX()) : Vec3d(Vec3d::UnitY());
  const Vec3d x = axis.cross(away).normalized(), y = axis.cross(x);
  const int count = side_count(bore.radius, bore.chord_tolerance > 0 ? bore.chord_tolerance : 0.01 * bore.radius);
  const auto corner = [&](int i) -> Vec3d {
    const double angle = 2 * std::numbers::pi * i / count;
    return bore.origin + bore.radius * (std::cos(angle) * x + std::sin(angle) * y);
  };
  Cell cell;
  for (int i = 0; i < count; ++i) {
    const Vec3d a = corner(i), b = corner(i + 1);
    Vec3d inward = bore.origin - 0.5 * (a + b);
    inward /= inward.norm();
    cell.push_back({inward, inward.dot(a)});
  }
  cell.push_back({axis, axis.dot(bore.origin)});
  cell.push_back({-axis, -(axis.dot(bore.origin) + bore.depth)});
  return cell;
}

}  // namespace

Status validate_bore(const Bore& bore) {
  if (!bore.origin.allFinite() || !bore.direction.allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone, "the axis of the bore is not finite");
  if (bore.origin.cwiseAbs().maxCoeff() > 1e60 || bore.direction.cwiseAbs().maxCoeff() > 1e60)
    return Status::failure(StatusCode::invalid_argument, kNone, "the axis of the bore lies beyond 1e60");
  if (!(bore.direction.norm() > 1e-30))
    return Status::failure(StatusCode::invalid_argument, kNone, "the axis of the bore has no direction");
  if (!(bore.radius > 1e-30 && bore.radius <= 1e30))
    return Status::failure(StatusCode::invalid_argument, kNone, "a bore has a radius above 0 and up to 1e30, not %g", bore.radius);
  if (!(bore.depth > 1e-30 && bore.depth <= 1e30))
    return Status::failure(StatusCode::invalid_argument, kNone, "a bore has a depth above 0 and up to 1e30, not %g", bore.depth);
  if (!(bore.chord_tolerance >= 0 && bore.chord_tolerance <= bore.radius))
    return Status::failure(StatusCode::invalid_argument, kNone, "a chord tolerance is 0 to the radius, not %g",
                           bore.chord_tolerance);
  return {};
}

void drill_surface(const Bore& bore, const Workpiece& work, TearReport& report) {
  const SurfaceEditor::Mark before = work.editor.mark();
  const Cell cell = cell_of(bore);
  const GapRemoval removal = remove_cell(cell, faces_in_cell(cell, work.editor, work.posed), work.editor, work.posed);
  report.runs = removal.faces_removed > 0 ? 1 : 0;
  report.faces_crossed = removal.faces_crossed;
  report.blocked = removal.blocked;
  report.area_removed_posed = removal.area_posed;
  improve_faces(work.editor.touched_since(before), work.editor);
  if (bore.wall)
    report.open_sections =
        add_bore_wall(work.editor.opened(), bore.origin, bore.direction / bore.direction.norm(), bore.depth, work);
}

}  // namespace sunder::tear
