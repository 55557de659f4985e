#include "tear/operation/drill.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "core/operation/internal/check_ranges.h"
#include "core/operation/internal/describe_operations.h"
#include "tear/filling/bore_wall.h"
#include "tear/geometry/tolerances.h"
#include "tear/path/crack_points.h"
#include "tear/sheet/gap.h"
#include "tear/surface/improve.h"

namespace sunder::tear {
namespace {

constexpr std::size_t kMostSides = 1536;
/// Radius of the prism's core, by the distance of its sides from the axis.
constexpr double kCoreRadii = 0.999;

/// Unit vectors to the corners of a regular polygon whose sides come within `tolerance` (a fraction
/// of the radius) of the circle: a hexagon whose arcs are halved until they do. Uses only square
/// roots and sums, so that every mathematical library gives the same bits.
ScratchVector<Vec3d> circle_corners(const Vec3d& x, const Vec3d& y, double tolerance,
                                    ScratchMemory& memory) {
  const double half_root = 0.5 * std::sqrt(3.0);
  ScratchVector<Vec3d> corners({x, 0.5 * x + half_root * y, -0.5 * x + half_root * y}, &memory);
  for (std::size_t i = 0; i < 3; ++i) corners.push_back(-Vec3d(corners[i]));
  while (1 - norm(0.5 * (corners[0] + corners[1])) > tolerance &&
         2 * corners.size() <= kMostSides) {
    ScratchVector<Vec3d> finer(&memory);
    finer.reserve(2 * corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3d between = corners[i] + corners[(i + 1) % corners.size()];
      finer.push_back(corners[i]);
      finer.push_back(between / norm(between));
    }
    corners.swap(finer);
  }
  return corners;
}

/// The sides of the prism, then its two ends.
struct Prism {
  ScratchVector<PlaneSide> cell;
  CellSides::Core core;
};

Prism prism_of(const Bore& bore, ScratchMemory& memory) {
  const Vec3d axis = bore.direction / norm(bore.direction);
  const Vec3d away = std::abs(axis.x()) < 0.5 ? Vec3d(Vec3d::UnitX()) : Vec3d(Vec3d::UnitY());
  const Vec3d across = axis.cross(away);
  const Vec3d x = across / norm(across), y = axis.cross(x);
  const auto corners = circle_corners(
      x, y, bore.chord_tolerance > 0 ? bore.chord_tolerance / bore.radius : 0.01, memory);
  Prism prism{ScratchVector<PlaneSide>(&memory), {bore.origin, axis, 0.0, 0}};
  auto& [cell, core] = prism;
  cell.reserve(corners.size() + 2);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    Vec3d inward = -(a + b);
    inward /= norm(inward);
    cell.push_back({inward, dot(inward, bore.origin + bore.radius * a)});
  }
  cell.push_back({axis, dot(axis, bore.origin)});
  cell.push_back({-axis, -(dot(axis, bore.origin) + bore.depth)});
  core.sides = static_cast<Index>(corners.size());
  core.radius = kCoreRadii * norm(0.5 * bore.radius * (corners[0] + corners[1]));
  return prism;
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
  return check_ranges(bore);
}

namespace {

/// Whether a box may meet the cylinder around a bore.
class BoreReach {
 public:
  BoreReach(const Bore& bore, const PosedPoints& posed, const SurfaceEditor& editor)
      : frame_(posed.frame_along(axes_along(bore.direction), editor)),
        begin_(frame_.place_of(bore.origin)),
        depth_(bore.depth),
        radius_(bore.radius),
        // Coordinates of the bore are rounded in the model and in the frame.
        rounding_(kPosedCoordinates * (frame_.reach() + bore.origin.cwiseAbs().maxCoeff() +
                                       begin_.cwiseAbs().maxCoeff() + bore.depth + bore.radius)) {}

  [[nodiscard]] const Frame& frame() const { return frame_; }
  [[nodiscard]] bool may_meet(const FrameBox& box) const {
    const double margin = rounding_ + kPosedCoordinates * box.largest_coordinate();
    if (box.low.x() > begin_.x() + depth_ + margin || box.high.x() < begin_.x() - margin)
      return false;
    const double y = std::max({0.0, box.low.y() - begin_.y(), begin_.y() - box.high.y()}),
                 z = std::max({0.0, box.low.z() - begin_.z(), begin_.z() - box.high.z()});
    const double reach = radius_ + margin;
    return y * y + z * z <= reach * reach * (1 + kPosedCoordinates);
  }

 private:
  Frame frame_;
  Vec3d begin_;
  double depth_, radius_, rounding_;
};

GapRemoval remove_bore(const Bore& bore, const Workpiece& work) {
  const ScratchMemory::Frame memory_of_step(work.editor.scratch());
  const auto [cell, core] = prism_of(bore, work.editor.scratch());
  CellSides sides(cell, work.editor, work.posed, core);
  const BoreReach reach(bore, work.posed, work.editor);
  const auto faces =
      faces_in_cell(sides, reach.frame(), [&](const FrameBox& box) { return reach.may_meet(box); });
  return remove_cell(sides, faces, work.editor);
}

}  // namespace

void drill_surface(const Bore& bore, const Workpiece& work, Outcome& outcome) {
  TearReport& report = outcome.report;
  const EditLog::Mark before = work.editor.mark();
  const GapRemoval removal = remove_bore(bore, work);
  report.runs = removal.faces_removed > 0 ? 1 : 0;
  report.faces_crossed = removal.faces_crossed;
  report.blocked = removal.blocked + match_crack_points(before, work);
  report.area_removed_posed = removal.area_posed;
  improve_faces(before, work.editor);
  if (bore.wall)
    report.open_sections =
        add_bore_wall(work.editor.opened_edges.borders(), bore.origin,
                      bore.direction / norm(bore.direction), bore.depth, bore.wall_material, work);
}

}  // namespace sunder::tear
