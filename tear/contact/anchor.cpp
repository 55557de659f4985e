#include "tear/contact/anchor.h"

#include <algorithm>
#include <cmath>

#include "tear/geometry/cross.h"

namespace sunder::tear {
namespace {

Vec2d in_plane(const std::array<double, 3>& barycentric) {
  return {barycentric[1], barycentric[2]};
}

/// The coordinates of a place in a part of its triangle, both given in the triangle. Negative
/// outside the part.
std::array<double, 3> coordinates_in(Index face, const Vec2d& place, const SurfaceEditor& editor) {
  std::array<Vec2d, 3> corners;
  for (Index k = 0; k < 3; ++k) corners[k] = in_plane(editor.source_barycentric(3 * face + k));
  const double area = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double second = cross(place - corners[0], corners[2] - corners[0]) / area,
               third = cross(corners[1] - corners[0], place - corners[0]) / area;
  return {1 - second - third, second, third};
}

}  // namespace

Status check_anchor(const SurfaceAnchor& anchor, const SurfaceEditor& editor) {
  const auto& meshes = editor.source().meshes;
  if (anchor.mesh >= meshes.size())
    return Status::failure(StatusCode::index_out_of_range, anchor.mesh,
                           "the anchor is in mesh %u, the character has %zu", anchor.mesh,
                           meshes.size());
  const std::size_t origins =
      meshes[anchor.mesh].triangles.size() + editor.fillings.of(anchor.mesh).size();
  if (anchor.birth.triangle >= origins)
    return Status::failure(StatusCode::index_out_of_range, anchor.birth.triangle,
                           "the anchor is in triangle %u, mesh %u has %zu", anchor.birth.triangle,
                           anchor.mesh, origins);
  double sum = 0;
  for (const double part : anchor.birth.barycentric) {
    if (!std::isfinite(part))
      return Status::failure(StatusCode::non_finite_value, kNone,
                             "the place of the anchor is not finite");
    if (part < -kInFaceBarycentric)
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "a barycentric coordinate of the anchor is %g; it must be >= 0", part);
    sum += part;
  }
  if (std::abs(sum - 1) > kInFaceBarycentric)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the barycentric coordinates of the anchor sum to %g instead of 1", sum);
  return {};
}

std::optional<FoundPlace> find_part(const SurfaceAnchor& anchor, const SurfaceEditor& editor) {
  const Vec2d place = in_plane(anchor.birth.barycentric);
  FoundPlace best;
  double greatest = -kInFaceBarycentric;
  editor.origins.for_each_part(anchor.mesh, anchor.birth.triangle, [&](Index face) {
    const std::array<double, 3> at = coordinates_in(face, place, editor);
    const double least = std::min({at[0], at[1], at[2]});
    const bool is_better = least > greatest || (least == greatest && face < best.face);
    if (!is_better) return;  // also where rounding left the part no area
    greatest = least;
    best.face = face;
    best.barycentric = at;
  });
  if (best.face == kNone) return std::nullopt;
  double sum = 0;
  for (double& part : best.barycentric) sum += part = std::max(0.0, part);
  for (double& part : best.barycentric) part /= sum;
  return best;
}

}  // namespace sunder::tear
