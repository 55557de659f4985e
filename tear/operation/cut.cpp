#include "tear/operation/cut.h"

#include <algorithm>
#include <optional>

#include "core/internal/ordered.h"
#include "tear/filling/caps.h"
#include "tear/geometry/tolerances.h"
#include "tear/path/crack_points.h"
#include "tear/sheet/open_sheet.h"
#include "tear/sheet/sections.h"
#include "tear/surface/improve.h"

namespace sunder::tear {
namespace {

bool is_near(const Vec3d& vector) { return vector.cwiseAbs().maxCoeff() <= kFarthestMetres; }

Vec3d doubled_area(const std::vector<Vec3d>& polygon) {
  Vec3d area = Vec3d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i)
    area += (polygon[i] - polygon[0]).cross(polygon[(i + 1) % polygon.size()] - polygon[0]);
  return area;
}

/// The half-space bounded by the side of a polygon from corner `i` to the next. Nothing for a
/// repeated corner.
std::optional<PlaneSide> side_at(std::size_t i, const std::vector<Vec3d>& polygon,
                                 const Vec3d& normal) {
  const Vec3d inward = normal.cross(Vec3d(polygon[(i + 1) % polygon.size()] - polygon[i]));
  const double length = norm(inward);
  if (!(length > 0)) return std::nullopt;
  return PlaneSide{inward / length, dot(inward, polygon[i]) / length};
}

/// The normal of the plane, turned so that the polygon goes round it counterclockwise.
Vec3d turned_to(const std::vector<Vec3d>& polygon, const Vec3d& normal) {
  return dot(doubled_area(polygon), normal) < 0 ? Vec3d(-normal) : normal;
}

/// Whether a polygon in the plane is convex and has an area. Allocates nothing.
bool is_convex(const std::vector<Vec3d>& polygon, const Vec3d& normal) {
  double size = 0;
  for (const Vec3d& corner : polygon) size = std::max(size, norm(corner - polygon[0]));
  const Vec3d up = turned_to(polygon, normal);
  for (std::size_t i = 0; i < polygon.size(); ++i)
    if (const auto side = side_at(i, polygon, up))
      for (const Vec3d& corner : polygon)
        if (side->value(corner) < -kConvexSizes * size) return false;
  return dot(doubled_area(polygon), up) > kFlatSquaredSizes * size * size;
}

Status validate_sections(const std::vector<Vec3d>& sections) {
  for (Index i = 0; i < sections.size(); ++i) {
    if (!sections[i].allFinite())
      return Status::failure(StatusCode::non_finite_value, i,
                             "place %u of the sections is not finite", i);
    if (!is_near(sections[i]))
      return Status::failure(StatusCode::invalid_argument, i,
                             "place %u of the sections lies beyond 1e60", i);
  }
  return {};
}

Status validate_ray(const SectionRay& ray, const Vec3d& normal) {
  if (!ray.origin.allFinite() || !ray.direction.allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone, "the ray of the cut is not finite");
  if (!is_near(ray.origin) || !is_near(ray.direction))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the ray of the cut lies beyond 1e60");
  const double length = norm(ray.direction);
  if (!(length > kShortestDirection) ||
      !(norm(Vec3d(normal / norm(normal)).cross(Vec3d(ray.direction / length))) > kSteepSine))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the ray of the cut has no length along the plane");
  return {};
}

Index find_bone(const Skeleton& skeleton, const std::string& name) {
  const auto found = std::find_if(skeleton.bones.begin(), skeleton.bones.end(),
                                  [&](const Bone& bone) { return bone.name == name; });
  return found == skeleton.bones.end() ? kNone : static_cast<Index>(found - skeleton.bones.begin());
}

/// Per bone: whether it is the given one or below it. Empty without a bone.
ScratchVector<bool> subtree_of(const std::string& bone, const Skeleton& skeleton,
                               ScratchMemory& scratch) {
  ScratchVector<bool> is_below(&scratch);
  if (bone.empty()) return is_below;
  is_below.resize(skeleton.bones.size(), false);
  const Index root = find_bone(skeleton, bone);
  is_below[root] = true;
  for (Index i = root + 1; i < skeleton.bones.size(); ++i) {  // parents come first
    const auto parent = skeleton.bones[i].parent;
    is_below[i] = parent != kNone && is_below[parent];
  }
  return is_below;
}

}  // namespace

Status validate_cut(const PlaneCut& cut, const Skeleton& skeleton) {
  if (!cut.point.allFinite() || !cut.normal.allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone,
                           "the plane of the cut is not finite");
  if (!is_near(cut.point) || !is_near(cut.normal))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the plane of the cut lies beyond 1e60");
  if (!(norm(cut.normal) > kShortestDirection))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the normal of the cut has no length");
  if (Status status = validate_sections(cut.sections); !status) return status;
  if (cut.first_hit)
    if (Status status = validate_ray(*cut.first_hit, cut.normal); !status) return status;
  if (!cut.bone.empty() && find_bone(skeleton, cut.bone) == kNone)
    return Status::failure(StatusCode::not_found, kNone, "no bone is named '%.60s'",
                           cut.bone.c_str());
  if (cut.bounds.empty()) return {};
  if (cut.bounds.size() < 3)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the bounds have %zu corners; a polygon needs at least three",
                           cut.bounds.size());
  for (Index i = 0; i < cut.bounds.size(); ++i) {
    if (!cut.bounds[i].allFinite())
      return Status::failure(StatusCode::non_finite_value, i,
                             "corner %u of the bounds is not finite", i);
    if (!is_near(cut.bounds[i]))
      return Status::failure(StatusCode::invalid_argument, i,
                             "corner %u of the bounds lies beyond 1e60", i);
  }
  if (!is_convex(cut.bounds, cut.normal / norm(cut.normal)))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the bounds are not a convex polygon in the plane of the cut");
  return {};
}

void cut_surface(const PlaneCut& cut, const Workpiece& work, Outcome& outcome) {
  TearReport& report = outcome.report;
  const EditLog::Mark before = work.editor.mark();
  const Vec3d normal = cut.normal / norm(cut.normal);
  ScratchMemory& scratch = work.editor.scratch();
  Sheet sheet{{normal, dot(normal, cut.point)}, ScratchVector<Sheet::Bound>(&scratch)};
  sheet.bounds.reserve(cut.bounds.size());
  const Vec3d up = turned_to(cut.bounds, normal);
  for (std::size_t i = 0; i < cut.bounds.size(); ++i)
    if (const auto side = side_at(i, cut.bounds, up)) sheet.bounds.push_back({*side, kNone});
  const SectionLimits limits{cut.sections, cut.first_hit,
                             subtree_of(cut.bone, work.editor.character().skeleton, scratch)};
  const ScratchVector<Index> faces = faces_of_sections(
      sheet, limits, faces_across(sheet, work.editor, work.posed), work.editor, work.posed);
  const SheetOpening opening = open_sheet(sheet, faces, cut.caps, work, outcome.borders.lips);
  if (opening.edges.empty()) {  // The plane may still have turned edges out of its way.
    work.editor.roll_back(before);
    work.posed.forget_from(before.points);
    report.blocked = opening.blocked;
    return;
  }
  report.runs = opening.runs;
  report.faces_crossed = opening.faces_crossed;
  report.blocked = opening.blocked + match_crack_points(before, work);
  report.length_posed = opening.length_posed;
  if (cut.caps) add_caps(opening, normal, cut.cap_material, work, report, outcome.borders.lips);
  improve_faces(before, work.editor);
}

}  // namespace sunder::tear
